#pragma once
#include <cstdint>
#include <vector>

#include "talus/physics/block.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// The end of one trajectory.
struct StopRow {
  std::uint32_t source, block;
  End end;
  float diameter, mass;                           // of the block, or of its largest piece if it broke [m], [kg]
  float x_release, y_release;                     // [m, local]
  float energy_line;                              // `energy_line_angle` from the release to the end [rad]
  double x, y, z;                                 // where it ended [m, local]
  float seconds, max_speed, length, plan_length;  // [s], [m/s], [m], [m]
  float end_speed;                                // at the end of the path [m/s]
  std::uint32_t impacts;
};

/// The angle below the horizontal of the straight line between two places: the energy line of a block that starts and
/// ends there, also called reach angle or Fahrboeschung. NaN if they are the same.
///
///   angle = atan(drop / distance in plan)                  [rad]
double energy_line_angle(const Vec3& from, const Vec3& to);

StopRow stop_row(const Release& release, const Path& path);

/// A point of a recorded path, dense enough to draw.
struct PathPoint {
  double x, y, z, time;  // [m, local], [s]
};

/// A path written as a vector.
struct RecordedPath {
  StopRow stop;
  std::vector<PathPoint> points;
};

/// A path as points: its vertices, and points of the parabolas between them at most `spacing` apart in plan [m].
std::vector<PathPoint> points_of(const Path& path, double spacing);

}  // namespace talus
