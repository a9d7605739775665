#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "talus/io/results/run_record.hpp"
#include "talus/products/gully_stops.hpp"

namespace talus::run {

/// The blocks that stay in gullies too steep to rest in, and the cell in which most of them stay.
///
/// @param tally  of the same trajectories
io::GullyRecord gully_record(const GullyStops& stops, const Tally& tally, const io::LoadedScenario& loaded);

/// A warning that many blocks stay in such gullies, with the worst cell; empty if they are few.
///
/// @param released  all trajectories; `whole` is their name
std::vector<std::string> gully_warnings(const io::GullyRecord& gullies, std::uint64_t released,
                                        const std::string& whole = "trajectories");

}  // namespace talus::run
