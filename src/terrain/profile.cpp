#include "talus/terrain/profile.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

constexpr int kMantissa = 24;  // bits of a float: up to 2^24 multiples of a quantum are exact

/// Adds the columns of a segment that ends at the height `end`: the last ones rise by one quantum more than the first
/// ones, so that the end is met and the edge between them is concave.
void append_segment(std::vector<long long>& quanta, long long end, long long columns) {
  const long long rise = end - quanta.back();
  const long long steeper = ((rise % columns) + columns) % columns, each = (rise - steeper) / columns;
  for (long long c = 0; c < columns; ++c) quanta.push_back(quanta.back() + each + (c < columns - steeper ? 0 : 1));
}

}  // namespace

double Profile::height(double x) const {
  const auto next =
      std::upper_bound(nodes.begin(), nodes.end(), x, [](double at, const auto& n) { return at < n.x(); });
  if (next == nodes.begin()) return nodes.front().y();
  if (next == nodes.end()) return nodes.back().y();
  const Eigen::Vector2d &a = *(next - 1), &b = *next;
  return a.y() + (b.y() - a.y()) * ((x - a.x()) / (b.x() - a.x()));
}

ExtrudedProfile extrude(const Profile& profile, double step) {
  const auto [low, high] = std::minmax_element(profile.nodes.begin(), profile.nodes.end(),
                                               [](const auto& a, const auto& b) { return a.y() < b.y(); });
  ExtrudedProfile out;
  out.datum = 0.5 * (low->y() + high->y());
  const double quantum =
      std::exp2(std::ceil(std::log2(0.5 * (high->y() - low->y()) + 1.0)) - kMantissa);  // 1 m: margin for rounding
  const auto column_of = [&](double x) { return std::llround((x - profile.from()) / step); };
  const auto quanta_of = [&](double z) { return std::llround((z - out.datum) / quantum); };

  std::vector<long long> quanta{quanta_of(profile.nodes.front().y())};
  for (std::size_t i = 1; i < profile.nodes.size(); ++i) {
    const long long first = std::ssize(quanta) - 1;
    const long long columns = std::max(1LL, column_of(profile.nodes[i].x()) - first);  // 1: two nodes in one column
    append_segment(quanta, quanta_of(profile.nodes[i].y()), columns);
  }

  const int columns = static_cast<int>(quanta.size());
  const Grid grid{columns, 2, step, kProfileLine, profile.from() - 0.5 * step, -kProfileLine};
  out.heights = Raster<float>(grid, 0.0F);
  for (int c = 0; c < columns; ++c)
    out.heights.at(c, 0) = out.heights.at(c, 1) =
        static_cast<float>(static_cast<double>(quanta[static_cast<std::size_t>(c)]) * quantum);
  return out;
}

}  // namespace talus
