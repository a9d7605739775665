#pragma once
#include <span>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// A block, or a piece of it, that crossed a screen.
struct Crossing {
  std::uint32_t source, block, screen;  ///< index of the screen in the scenario
  std::uint32_t piece;                  ///< `Release::piece`: 0 is the block or its largest piece
  double x, y;                          // [m, local]
  double speed, height, spin;           // [m/s], vertical above the terrain [m], [rad/s]
  double mass, diameter;                // [kg], [m]
  double along;                         ///< distance along the line from its start [m]
  double time;                          // [s]
  double dip = 0.0;                     ///< of the velocity below the horizontal, negative where it rises [rad]
  double incidence = 0.0;               ///< in plan, between the way and the normal of the line [rad], 0 to pi/2
};

/// Distance from the start of a screen, along all its lines, to its point nearest to `place` [m].
double place_along(const Screen& screen, const Eigen::Vector2d& place);

/// Length of a line of a screen [m].
double length_of(const std::vector<Eigen::Vector2d>& line);

/// The part of a screen between two distances from its start, along all its lines [m], from < to: as long as both are
/// on the same of its lines, else what is on that one on which the middle lies.
std::vector<Eigen::Vector2d> part_along(const Screen& screen, double from, double to);

/// Finds where paths cross the screens.
class ScreenFinder {
 public:
  explicit ScreenFinder(const Scenario& scenario) : ScreenFinder(scenario.surface, scenario.screens) {}
  /// The surface must outlive the finder.
  ScreenFinder(const Surface& surface, std::span<const Screen> screens);

  /// Appends every crossing of the path, in the order of time.
  void find(const Release& release, const Path& path, std::vector<Crossing>& crossings) const;

 private:
  void cross(const Release& release, const Block& body, const Vertex& from, const Vertex& to,
             std::vector<Crossing>& crossings) const;

  const Surface& surface_;
  std::vector<LinePiece> pieces_;
  Eigen::Vector2d low_, high_;  // box around all pieces
};

}  // namespace talus
