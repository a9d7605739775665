#pragma once
#include <span>
#include <string>

#include "talus/io/results/write_profile.hpp"

namespace talus::io {

/// A drawing of the results, SVG that needs no other file: the profile with some paths, the envelopes of speed, energy
/// and jump height along it, and the share of the blocks that goes farther than a distance.
std::string profile_svg(const LoadedProfile& profile, const ProfileResults& results,
                        std::span<const RecordedPath> paths);

}  // namespace talus::io
