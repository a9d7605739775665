#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/fit/campaign/name_stream.hpp"
#include "talus/physics/block.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Measurements of a block at its first crossing of a screen. NaN: crossed, but not measured.
struct Passage {
  double speed = kNotGiven;  ///< in space [m/s]
  double jump = kNotGiven;   ///< of the block's lowest point above the terrain, vertical [m]
  double spin = kNotGiven;   ///< angular velocity [rad/s]
};

/// A state that was measured along a path.
struct Sample {
  double x = 0.0, y = 0.0, z = 0.0;  ///< [m, local]
  double distance = 0.0;             ///< in plan from the block's nominal place of release [m]
  double speed = kNotGiven;          ///< [m/s]; NaN: not measured
  double spin = kNotGiven;           ///< [rad/s]; NaN: not measured
};

/// A block that was released, with its measurements.
struct MeasuredBlock {
  std::string id;
  std::uint32_t stream = 0;     ///< of its random numbers: stream_of_name(id), else blocks have the same random numbers
  double x = 0.0, y = 0.0;      ///< nominal place of release [m, local]
  double release_height = 1.0;  ///< of the block's lowest point above the terrain [m]
  double release_radius = 0.0;  ///< the place of release is uniform in a disc of this radius around (x, y) [m]
  Vec3 velocity = Vec3::Zero();  ///< at the release [m/s]
  double mass = 1.0;             ///< [kg], > 0
  double density = 2700.0;       ///< [kg/m^3], > 0
  Vec3 axes = Vec3::Ones();      ///< L1 >= L2 >= L3 [m]; of a sphere of this mass where they are not given
  int day = 0;                   ///< of the release; 0: not given
  std::string group;             ///< empty: none
  std::string rock;              ///< its name, the same for each release of it; empty: known by its size
  bool holdout = false;          ///< never enters a fit

  std::optional<Eigen::Vector2d> stop;           ///< place of rest [m, local]
  std::optional<double> stop_mass;               ///< mass that arrived there [kg]
  std::vector<std::optional<Passage>> passages;  ///< first crossing of each screen of the campaign; empty: none
  std::vector<Sample> samples;                   ///< nearest to the release first
};

/// Standard deviations of the measurement. Normal errors of this size are added to the simulated values before they are
/// compared with the measured ones.
struct MeasurementError {
  double position_m = 0.0;                 ///< of each coordinate of a stop [m]
  double speed_fraction = 0.0;             ///< of a speed, relative to it [-]
  double jump_height_m = 0.0;              ///< of a jump height, which is cut off at 0 [m]
  double angular_velocity_fraction = 0.0;  ///< of a spin, relative to it [-]
};

struct MappedDeposits;

/// Measured data: the place, the released blocks, the observations. Valid by construction: `io::read_campaign` builds
/// it. docs/closing-the-loop.md, "Campaign".
struct Campaign {
  std::string name;
  Surface surface{Raster<float>{}};
  Raster<std::uint8_t> zones;           ///< index into zone_names; empty where one ground is everywhere
  std::vector<std::string> zone_names;  ///< "default" (ground outside all zones) first, then those of the campaign
  std::vector<MeasuredBlock> blocks;    ///< in the order of their ids, whatever that of the file is
  std::vector<Screen> screens;          ///< in the order of their ids
  MeasurementError error;
  /// Where the blocks may have come from, if they were mapped where they lie; else null, and their releases are known.
  std::shared_ptr<const MappedDeposits> deposits = nullptr;
};

/// The blocks that may enter a fit: true where holdout is not set. Size: blocks.
std::vector<bool> fitting_rows(const Campaign& campaign);
/// The blocks that are held out.
std::vector<bool> holdout_rows(const Campaign& campaign);
/// Number of the blocks that are asked for.
std::size_t count_of_rows(const std::vector<bool>& rows);
/// Whether all blocks of some rows were released and came to rest on the terrain, so that none is missing because it
/// left. Trials that left went farther than these. Where blocks are missing, the others are those that happened to
/// stay, and compare with the trials that stay. So do mapped blocks, of which those that left were never seen.
bool all_at_rest(const Campaign& campaign, const std::vector<bool>& rows);
/// The random streams of the blocks, for draws over blocks. Size: blocks.
std::vector<std::uint32_t> streams_of(const Campaign& campaign);

/// The body of a measured block: a sphere of its mass and density, with its axes.
Block body_of(const MeasuredBlock& block);

/// Diameter of the sphere of a mass [kg] and a density [kg/m^3]: (6 m / (pi rho))^(1/3) [m].
double equivalent_diameter(double mass, double density);

}  // namespace talus
