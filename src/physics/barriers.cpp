#include "talus/physics/barriers.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace talus {
namespace {

constexpr std::size_t kPiecesInBox = 8;

}  // namespace

Meeting meeting(const Barrier& barrier, double clearance, double energy) {
  if (clearance >= barrier.height) return Meeting::Over;
  return energy > barrier.capacity ? Meeting::Broken : Meeting::Caught;
}

double kept_speed(double energy, double capacity) {
  return std::sqrt(std::clamp((energy - capacity) / energy, 0.0, 1.0));
}

Barriers::Barriers(std::vector<Barrier> barriers) : barriers_(std::move(barriers)) {
  for (std::uint32_t b = 0; b < barriers_.size(); ++b)
    lengths_.push_back(append_pieces(b, barriers_[b].lines, pieces_));
  for (std::size_t first = 0; first < pieces_.size(); first += kPiecesInBox) {
    const std::size_t end = std::min(first + kPiecesInBox, pieces_.size());
    Box box{pieces_[first].from, pieces_[first].from, static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(end)};
    for (std::size_t i = first; i < end; ++i) {
      box.low = box.low.cwiseMin(pieces_[i].from).cwiseMin(pieces_[i].to);
      box.high = box.high.cwiseMax(pieces_[i].from).cwiseMax(pieces_[i].to);
    }
    boxes_.push_back(box);
  }
}

std::optional<Barriers::Cut> Barriers::next(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                            const std::optional<Cut>& last) const {
  const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
  const auto place = [](const Cut& cut) { return std::tuple(cut.share, cut.piece); };
  std::optional<Cut> found;
  for (const Box& box : boxes_) {
    if ((high.array() < box.low.array()).any() || (low.array() > box.high.array()).any()) continue;
    for (std::uint32_t i = box.first; i < box.end; ++i) {
      const std::optional<WayCrossing> crossing = crossing_of(a, b, pieces_[i]);
      if (!crossing) continue;
      const Cut cut{crossing->share, i, pieces_[i].owner, crossing->along};
      if (last && place(cut) <= place(*last)) continue;
      if (!found || place(cut) < place(*found)) found = cut;
    }
  }
  return found;
}

}  // namespace talus
