#pragma once
#include <cstdint>
#include <span>

namespace talus {

/// Expected number of cells that are reached by `times` as many trajectories as a sample has.
///
/// The rates of the cells are taken as gamma distributed, so the numbers of passages are negative binomial. The two
/// parameters follow from the ratios of the numbers of cells with one, two and three passages; they give the number of
/// cells that the sample missed. Source: Fisher, Corbet and Williams, J. Animal Ecology 12, 1943; Efron and Thisted,
/// Biometrika 63, 1976.
///
/// @param cells  number of cells with 0, 1, 2, 3, and 4 or more passages in the sample; all count as reached
/// @param most   upper limit of the result: the number of all cells
double expected_cells(std::span<const std::uint64_t> cells, double times, double most);

}  // namespace talus
