#include "campaign_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/sample.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kFewestToJudge = 5;  // values of which a spread or a median is formed, as of a group of the score
constexpr const char* kUnits = "are masses in kg, axes in m and densities in kg/m3?";

double mass_of_ellipsoid(const MeasuredBlock& b) {
  return b.density * kPi / 6.0 * b.axes.prod();
}

/// Whether the axes are those of the sphere of the mass, as where none were given.
bool is_own_sphere(const MeasuredBlock& b) {
  return b.axes[0] == b.axes[2] && b.axes[0] == equivalent_diameter(b.mass, b.density);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::string share_of(std::size_t some, std::size_t all) {
  return std::to_string(some) + " of " + std::to_string(all);
}

/// Height that a speed lifts a block to [m].
double lift_of(double speed) {
  return speed * speed / (2.0 * kGravity);
}

/// The highest ground of a disc of release: of its middle and eight places on its rim [m]. NaN off the terrain.
double highest_ground(const Surface& surface, const MeasuredBlock& block) {
  constexpr int kDirections = 8;
  double highest = surface.height(block.x, block.y).value_or(kNotGiven);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections, r = block.release_radius;
    const auto height = surface.height(block.x + r * std::cos(angle), block.y + r * std::sin(angle));
    if (height) highest = std::max(highest, *height);
  }
  return highest;
}

/// Gradient of the ground at a place; none off the terrain.
Eigen::Vector2d gradient_at(const Surface& surface, const Eigen::Vector2d& place) {
  const PatchIndex at = surface.patch_at(place.x(), place.y());
  Patch patch;
  if (!surface.read(at, patch)) return Eigen::Vector2d::Zero();
  const double p = surface.u_of(place.x()) - at.column, q = surface.v_of(place.y()) - at.row;
  return surface.gradient(surface.facet(patch, p, q, Vec3::Zero()), p, q);
}

/// A quantity whose error is added to simulated values.
struct WithError {
  const char* key;
  double error;  ///< as campaign.toml gives it
  const char *what, *unit;
  bool relative;  ///< to the value
  std::vector<double> values = {};
};

void warn_of_error(const std::string& path, const WithError& q, double spread, std::vector<std::string>& warnings) {
  constexpr double kMostOfSpread = 0.5;  // adds a quarter to the variance of a right model
  const double error = q.relative ? q.error * mean_of(q.values) : q.error;
  if (q.values.size() < kFewestToJudge || !(spread > 0.0) || error <= kMostOfSpread * spread) return;
  warnings.push_back(path + ": [measurement_error] " + q.key + " = " + text_of(q.error) +
                     (q.relative ? ", " + with_digits(error, 3) + " " + q.unit + " of the mean" : "") +
                     ": is more than half of the spread of the " + q.what + ", whose standard deviation is " +
                     with_digits(spread, 3) + " " + q.unit + " (" + std::to_string(q.values.size()) +
                     " values): the error that is added to simulated values may hide what the model " + "does wrong; " +
                     (q.relative ? "is it a share, such as 0.03 for 3 %?"
                                 : "is it in m, such as 0.3 for 30 cm, and not the largest error?"));
}

}  // namespace

void warn_of_median(const std::string& path, std::span<const MeasuredBlock> blocks,
                    std::vector<std::string>& warnings) {
  constexpr double kSmall = 0.15, kLarge = 10.0;  // diameter of a sphere of the same volume [m]
  std::vector<double> diameters;
  for (const MeasuredBlock& b : blocks) diameters.push_back(equivalent_diameter(b.mass, b.density));
  const double median = median_of(std::move(diameters));
  if (median >= kSmall && median <= kLarge) return;
  warnings.push_back(path + ": half of the blocks are " + (median < kSmall ? "smaller" : "larger") + " than " +
                     with_digits(median, 2) + " m across: are masses in kg, lengths in m and densities in kg/m3?");
}

void warn_of_masses(const std::string& path, std::span<const MeasuredBlock> blocks,
                    std::vector<std::string>& warnings) {
  const auto differs = [&](const MeasuredBlock& b) {
    return b.mass > kMassFactor * mass_of_ellipsoid(b) || mass_of_ellipsoid(b) > kMassFactor * b.mass;
  };
  const auto first = std::ranges::find_if(blocks, differs);
  if (first != blocks.end()) {
    warnings.push_back(path + ": the mass of " +
                       share_of(static_cast<std::size_t>(std::ranges::count_if(blocks, differs)), blocks.size()) +
                       " blocks is more than 3 times above or below that of an ellipsoid of their axes and density: " +
                       "block '" + first->id + "' has " + with_digits(first->mass, 4) + " kg, its ellipsoid " +
                       with_digits(mass_of_ellipsoid(*first), 4) + " kg; " + kUnits);
    return;
  }
  constexpr double kLeast = 1.0 / 1.5, kMost = 2.0;  // a cuboid has 1.91 times the volume of the ellipsoid in it
  std::vector<double> ratios;
  for (const MeasuredBlock& b : blocks)
    if (!is_own_sphere(b)) ratios.push_back(b.mass / mass_of_ellipsoid(b));
  if (ratios.size() < kFewestToJudge) return;
  const std::size_t count = ratios.size();
  const double median = median_of(std::move(ratios));
  if (median >= kLeast && median <= kMost) return;
  warnings.push_back(
      path + ": the masses of " + std::to_string(count) + " blocks are " + with_digits(median, 2) +
      " times those of ellipsoids of their axes and density (median), must be about 1 to 1.9 times, an " +
      "ellipsoid's to a cuboid's: " + kUnits);
}

void warn_of_diameters(const std::string& path, std::vector<double> ratios, std::vector<std::string>& warnings) {
  constexpr double kMost = 1.5;
  if (ratios.size() < kFewestToJudge) return;
  const double median = median_of(std::move(ratios));
  if (median <= kMost && median >= 1.0 / kMost) return;
  warnings.push_back(path + ": mass_kg, which counts, is " + with_digits(median, 2) +
                     " times the mass of a sphere of diameter_m (median), must be about the same: " +
                     "is the mass in kg, the diameter in m and that of the sphere of the block's volume?");
}

double doubted_height(const Raster<float>& heights) {
  constexpr double kLow = 10.0, kReach = 50.0;  // of an excavator, whatever the relief, and of a crane [m]
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float z : heights.values)
    if (!std::isnan(z)) low = std::min(low, z), high = std::max(high, z);
  return std::clamp<double>(high - low, kLow, kReach);
}

void warn_of_releases(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings) {
  constexpr double kMostOut = 10.0;  // lifts a block 5 m above the ground [m/s]
  const double most = doubted_height(campaign.surface.heights());
  std::vector<std::string> high, upwards;
  for (const MeasuredBlock& block : campaign.blocks) {
    if (block.release_height > most) high.push_back(block.id + " (" + with_digits(block.release_height, 3) + " m)");
    const double out = block.velocity.dot(normal_of(gradient_at(campaign.surface, {block.x, block.y})));
    if (block.velocity.z() > 0.0 && out > kMostOut)
      upwards.push_back(block.id + " (vz " + with_digits(block.velocity.z(), 3) + " m/s)");
  }
  if (!high.empty())
    warnings.push_back(path + ": " + share_of(high.size(), campaign.blocks.size()) +
                       " blocks are released higher above the ground than " + with_digits(most, 3) + " m" +
                       (most > 10.0 && most < 50.0 ? ", the relief of the DEM" : "") + ": " + listed(high) +
                       "; is release_height_m in m above the ground? A helicopter may drop them from there");
  if (!upwards.empty())
    warnings.push_back(path + ": " + share_of(upwards.size(), campaign.blocks.size()) +
                       " blocks leave the ground upwards at more than 10 m/s at their release: " + listed(upwards) +
                       "; is the sign of vz right (upwards is positive), and is it in m/s?");
}

void warn_of_rises(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings) {
  constexpr double kErrors = 3.0;      // standard deviations of the place of rest, up the slope there
  constexpr double kErrorOfDem = 0.5;  // [m]
  std::vector<std::string> higher, nowhere;
  std::size_t stops = 0;
  for (const MeasuredBlock& block : campaign.blocks) {
    if (!block.stop) continue;
    ++stops;
    const auto stop = campaign.surface.height(block.stop->x(), block.stop->y());
    if (!stop) {
      nowhere.push_back(block.id);
      continue;
    }
    const double rise = *stop - highest_ground(campaign.surface, block);
    const double error =
        kErrors * campaign.error.position_m * gradient_at(campaign.surface, *block.stop).norm() + kErrorOfDem;
    if (rise - error > block.release_height + lift_of(block.velocity.norm()))
      higher.push_back(block.id + " (" + with_digits(rise, 3) + " m)");
  }
  if (!higher.empty())
    warnings.push_back(path + ": " + share_of(higher.size(), stops) +
                       " blocks came to rest higher above the ground at their release than the height and speed of " +
                       "the release and the error of the place allow: " + listed(higher) +
                       "; no block can get there: is a release or a stop mistyped, or are the two exchanged?");
  if (!nowhere.empty())
    warnings.push_back(path + ": " + share_of(nowhere.size(), stops) +
                       " blocks came to rest where the DEM has no heights, so that no simulated block can: " +
                       listed(nowhere) + "; is the place mistyped? Fill the gap, or leave these rows out");
}

void warn_of_errors(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings) {
  const MeasurementError& e = campaign.error;
  std::vector<double> x, y;
  WithError speed{"speed_fraction", e.speed_fraction, "measured speeds", "m/s", true};
  WithError jump{"jump_height_m", e.jump_height_m, "measured jump heights", "m", false};
  WithError spin{"angular_velocity_fraction", e.angular_velocity_fraction, "measured angular velocities", "rad/s",
                 true};
  const auto add = [](WithError& quantity, double value) {
    if (!std::isnan(value)) quantity.values.push_back(value);
  };
  for (const MeasuredBlock& block : campaign.blocks) {
    if (block.stop) x.push_back(block.stop->x()), y.push_back(block.stop->y());
    for (const auto& passage : block.passages) {
      if (!passage) continue;
      add(speed, passage->speed), add(jump, passage->jump), add(spin, passage->spin);
    }
    for (const Sample& sample : block.samples) add(speed, sample.speed), add(spin, sample.spin);
  }
  if (!x.empty()) {
    const double spread = std::hypot(deviation_of(x), deviation_of(y)) / std::sqrt(2.0);
    warn_of_error(path, {"position_m", e.position_m, "places of rest, in a coordinate", "m", false, x}, spread,
                  warnings);
  }
  for (const WithError* quantity : {&speed, &jump, &spin})
    if (!quantity->values.empty()) warn_of_error(path, *quantity, deviation_of(quantity->values), warnings);
}

}  // namespace talus::io
