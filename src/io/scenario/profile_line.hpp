#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "talus/io/gdal/rasters.hpp"
#include "talus/terrain/profile.hpp"

namespace talus::io {

/// A line over a DEM as a profile.
struct ProfileLine {
  Profile profile;                           ///< x is the distance along the line in plan [m]
  std::vector<Eigen::Vector2d> plan;         ///< its vertices in local metres of the DEM
  double most_off = 0.0, most_off_at = 0.0;  ///< largest vertical distance of a sample, and its x [m]
};

/// Samples the terrain along a line: at its vertices, and where it crosses the lines between the centres of cells, the
/// edges of the patches; on a creased surface also where it crosses diagonals between centres. Between two samples the
/// profile is straight. Points nearer than `step` to the one before are left out. Throws InputError if a part of the
/// line has no terrain under it.
ProfileLine profile_along(const std::vector<Eigen::Vector2d>& plan, const Surface& surface, double step,
                          const std::string& name);

/// Reads the one line of a vector file and samples it. Throws InputError unless it is one line.
ProfileLine read_profile_line(const std::string& path, const Terrain& terrain, const ScenarioSpec& spec,
                              LoadedScenario& out);

}  // namespace talus::io
