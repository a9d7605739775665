#pragma once
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/terrain/profile.hpp"

namespace talus::io {

/// A profile with all that a run on it needs.
struct LoadedProfile {
  LoadedScenario
      loaded;          ///< on the extruded profile: `geo.west` + local x is x of the profile; y is 0; z above `datum`
  Profile profile;     ///< x is the distance along the line if it was drawn over a DEM
  double datum = 0.0;  ///< of the heights in `loaded` [m]
  double step = 0.1, bin = 5.0;       ///< [m]
  std::vector<Eigen::Vector2d> plan;  ///< the line in map coordinates; empty for a polyline of x, z
  GeoReference map;                   ///< system of `plan`

  /// Where a point of the profile is drawn: (x, z) of a polyline, else its place on the map.
  Eigen::Vector2d place(double x, double z) const;
};

/// The flags of `talus profile`.
struct ProfileFlags {
  RunFlags run;  ///< of these: scenario (the file of the profile; empty: from flags alone), dem, surface, preset,
                 ///< diameter, deformation_coefficient, trajectories, seed
  std::optional<std::string> line;       ///< over the DEM
  std::vector<double> source;            ///< x of the releases, one or from and to [m]; empty: not given
  std::optional<double> release_height;  ///< [m]
  std::vector<double> screens;           ///< x [m]; empty: not given
};

/// Reads and checks a profile and its settings, docs/profile.md. Throws InputError, one line.
LoadedProfile load_profile(const ProfileFlags& flags);

/// Reads a polyline: a CSV with the columns x and z, x ascending by at least `step`.
/// Throws InputError with file, line, value and what is allowed.
Profile read_profile_csv(const std::string& path, double step);

}  // namespace talus::io
