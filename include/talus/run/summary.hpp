#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "talus/physics/effects/registry.hpp"
#include "talus/simulate/totals.hpp"

namespace talus::run {

/// Texts about the totals of a run.

/// 1234567 as "1 234 567".
std::string count_text(std::uint64_t count);

/// "3.14 %".
std::string share_text(std::uint64_t part, std::uint64_t whole);

/// "12 stopped, 1 trapped, 3 left the map, 0 caught, 0 at a limit".
///
/// @param terrain  what they left: "map" or "profile"
std::string ends_text(const Totals& totals, const std::string& terrain = "map");

/// "12 of 3 400 trajectories (0.353 %, allowed are 0.1 %) ended at the limit of impacts, time or vertices".
std::string limits_text(const Totals& totals);

/// "barrier net: 3 937 caught, 8 over it, 0 through it (it broke)"; "3 937 blocks and pieces caught" if blocks broke:
/// each piece is caught or goes over alone, so that the sum may exceed the number of blocks that ended as `caught`.
std::string barrier_text(const std::string& id, const BarrierCounts& counts, bool pieces);

/// Warnings about trajectories that left the DEM, also with a piece alone, or were trapped; empty if they are few.
///
/// @param into_gaps  how many of them left, with their largest piece, into gaps inside the DEM
/// @param whole      name of what `totals` sums over
std::vector<std::string> warnings_of(const Totals& totals, std::uint64_t into_gaps = 0,
                                     const std::string& whole = "trajectories");

/// Warnings of `talus profile` if many trajectories left the profile, or were trapped.
std::vector<std::string> profile_warnings(const Totals& totals);

/// `limits_text` with the way out of `talus profile`, whose trajectories `talus trace` cannot replay.
std::string profile_limits_text(const Totals& totals);

/// A warning that a plan has very many trajectories, with their time; nothing if it has not.
///
/// @param parts  equal parts of it, of which one is run
std::optional<std::string> many_trajectories_warning(std::uint64_t trajectories, std::uint32_t parts = 1);

/// A warning that many blocks hardly left their source; empty if they are few.
///
/// @param held, released  numbers of trajectories, `held_at_release` and all
std::vector<std::string> held_warnings(std::uint64_t held, std::uint64_t released, const Effects& effects,
                                       const std::string& whole = "trajectories");

}  // namespace talus::run
