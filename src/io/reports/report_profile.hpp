#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "markup.hpp"

namespace talus::io {

/// The drawing and the run-out of a run on a profile.
struct ProfilePart {
  std::string drawing;  ///< profile.svg
  std::string note;     ///< why there is no drawing
  /// A distance in x from the release that some blocks go beyond; NaN where the profile ends before.
  struct Reach {
    double share, distance;  ///< of the blocks; [m]
  };
  std::vector<Reach> reaches;  ///< the largest share first; empty without runout.csv
  double end = 0.0;            ///< to which the table goes [m]
};

/// Throws InputError if runout.csv is there and cannot be understood, or is of another run.
///
/// @param stops  blocks of the run that stopped, were trapped or caught
ProfilePart read_profile_part(const std::filesystem::path& folder, double stops);
Markup profile_html(const ProfilePart& part);

}  // namespace talus::io
