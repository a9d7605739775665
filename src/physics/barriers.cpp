#include "talus/physics/barriers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace talus {
namespace {

constexpr std::size_t kSegmentsInBox = 8;

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

Meeting meeting(const Barrier& barrier, double clearance, double energy) {
  if (clearance >= barrier.height) return Meeting::Over;
  return energy > barrier.capacity ? Meeting::Broken : Meeting::Caught;
}

double kept_speed(double energy, double capacity) {
  return std::sqrt(std::clamp((energy - capacity) / energy, 0.0, 1.0));
}

Barriers::Barriers(std::vector<Barrier> barriers) : barriers_(std::move(barriers)) {
  for (std::uint32_t b = 0; b < barriers_.size(); ++b) {
    double along = 0.0;
    for (const auto& line : barriers_[b].lines)
      for (std::size_t i = 1; i < line.size(); ++i) {
        segments_.push_back({b, line[i - 1], line[i], along});
        along += (line[i] - line[i - 1]).norm();
      }
    lengths_.push_back(along);
  }
  for (std::size_t first = 0; first < segments_.size(); first += kSegmentsInBox) {
    const std::size_t end = std::min(first + kSegmentsInBox, segments_.size());
    Box box{segments_[first].from, segments_[first].from, static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(end)};
    for (std::size_t i = first; i < end; ++i) {
      box.low = box.low.cwiseMin(segments_[i].from).cwiseMin(segments_[i].to);
      box.high = box.high.cwiseMax(segments_[i].from).cwiseMax(segments_[i].to);
    }
    boxes_.push_back(box);
  }
}

std::optional<Barriers::Cut> Barriers::next(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                            const std::optional<Cut>& last) const {
  const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b), way = b - a;
  const auto place = [](const Cut& cut) { return std::tuple(cut.share, cut.segment); };
  std::optional<Cut> found;
  for (const Box& box : boxes_) {
    if ((high.array() < box.low.array()).any() || (low.array() > box.high.array()).any()) continue;
    for (std::uint32_t i = box.first; i < box.end; ++i) {
      const Segment& s = segments_[i];
      const Eigen::Vector2d line = s.to - s.from;
      const double side_a = cross_product(line, a - s.from), side_b = cross_product(line, b - s.from);
      if ((side_a < 0.0) == (side_b < 0.0)) continue;
      const double side_from = cross_product(way, s.from - a), side_to = cross_product(way, s.to - a);
      if ((side_from < 0.0) == (side_to < 0.0)) continue;
      const Cut cut{side_a / (side_a - side_b), i, s.barrier,
                    s.along + line.norm() * (side_from / (side_from - side_to))};
      if (last && place(cut) <= place(*last)) continue;
      if (!found || place(cut) < place(*found)) found = cut;
    }
  }
  return found;
}

}  // namespace talus
