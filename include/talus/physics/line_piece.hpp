#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "talus/base/vector.hpp"

namespace talus {

/// A straight piece of a line in plan, of a barrier or of a screen.
struct LinePiece {
  std::uint32_t owner;       ///< index of its barrier or screen
  Eigen::Vector2d from, to;  ///< [m, local]
  double along;              ///< distance of `from` from the start of the owner, along all its lines [m]
};

/// Appends the pieces of all lines of a barrier or of a screen.
///
/// @return  length of its lines [m]
inline double append_pieces(std::uint32_t owner, std::span<const std::vector<Eigen::Vector2d>> lines,
                            std::vector<LinePiece>& pieces) {
  double along = 0.0;
  for (const auto& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      pieces.push_back({owner, line[i - 1], line[i], along});
      along += (line[i] - line[i - 1]).norm();
    }
  return along;
}

/// Where a straight way in plan crosses a piece.
struct WayCrossing {
  double share;  ///< of the way before the crossing, 0..1
  double along;  ///< distance from the start of the owner, along all its lines [m]
};

inline double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The way from `a` to `b` crosses a piece if its ends lie on different sides of the piece, and the ends of the piece
/// on different sides of the way. A point on the line itself belongs to one fixed side, so that a way through a corner
/// of a path or of a line crosses once.
inline std::optional<WayCrossing> crossing_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                              const LinePiece& piece) {
  const Eigen::Vector2d way = b - a, line = piece.to - piece.from;
  const double side_a = cross_product(line, a - piece.from), side_b = cross_product(line, b - piece.from);
  if ((side_a < 0.0) == (side_b < 0.0)) return std::nullopt;
  const double side_from = cross_product(way, piece.from - a), side_to = cross_product(way, piece.to - a);
  if ((side_from < 0.0) == (side_to < 0.0)) return std::nullopt;
  return WayCrossing{side_a / (side_a - side_b), piece.along + line.norm() * (side_from / (side_from - side_to))};
}

}  // namespace talus
