#include "talus/simulate/scenario/doubled_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "talus/base/text.hpp"

namespace talus {
namespace {

/// All that a point says of its blocks.
struct SourcePoint {
  std::pair<std::array<double, 10>, std::string_view> key;  // place, fields; name
  std::int64_t id;
};

SourcePoint source_point(const SourceCell& cell, const SourceFeature& feature) {
  const auto ordered = [](double value) { return std::isnan(value) ? HUGE_VAL : value; };
  const bool named = feature.name != std::to_string(feature.id);  // else its number stands for the name
  return {{{cell.x, cell.y, ordered(feature.frequency), ordered(feature.diameter.low), ordered(feature.diameter.high),
            feature.release_height.low, feature.release_height.high, feature.velocity.x(), feature.velocity.y(),
            feature.velocity.z()},
           named ? std::string_view(feature.name) : std::string_view()},
          feature.id};
}

}  // namespace

std::string doubled_points_warning(const Scenario& s) {
  std::vector<SourcePoint> points;
  for (const SourceCell& cell : s.sources)
    if (cell.point) points.push_back(source_point(cell, s.features[cell.feature]));
  std::ranges::stable_sort(points, {}, &SourcePoint::key);
  std::vector<std::string> again;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].key == points[i - 1].key) again.push_back(std::to_string(points[i].id));
  if (again.empty()) return {};
  return kDoubledPoints +
         (again.size() == 1 ? std::string("1 point has") : std::to_string(again.size()) + " points have") +
         " the place and the fields of another (FID " + listed(again) +
         "), and each releases its own blocks: delete what is there twice, unless it is meant";
}

}  // namespace talus
