#pragma once
#include <cstdint>
#include <span>

namespace talus {

/// How many cells `times` as many trajectories reach as a sample.
///
/// The cells that few of the sample reach tell of those that none does. Their rates are taken as gamma distributed, so
/// that the numbers of passages are negative binomial: its two parameters follow from the ratios of the cells with one,
/// two and three. Source: Fisher, Corbet and Williams, J. Animal Ecology 12, 1943; Efron and Thisted, Biometrika 63,
/// 1976.
///
/// @param cells  with 0, 1, 2, 3, and 4 or more of the sample
/// @param most   there are
double expected_cells(std::span<const std::uint64_t> cells, double times, double most);

}  // namespace talus
