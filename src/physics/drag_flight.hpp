#pragma once
#include <optional>

#include "talus/physics/effects/damped_fall.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/world.hpp"

namespace talus {

class BarrierWatch;
struct BarrierMet;

/// Flight through vegetation, air and stems, in pieces of constant drag rate. In a piece the block follows the parabola
/// that ends where the damped fall ends; then it gets the velocity of the damped fall. docs/effects.md, "Flight with
/// drag".
///
/// In a piece the block moves at most one cell, and drag takes at most 4 % of its speed (`Effort::drag_loss`); but a
/// piece lasts at least 0.01 s, unless it ends at a stem or a barrier, so that the number of pieces is limited for a
/// block stuck in vegetation. Linear drag is exact. Quadratic drag has mean rates of the piece; the speed at a landing
/// is right to 1e-3, at a landing from rest to 2e-4.
class DragFlight {
 public:
  DragFlight(const World& world, const Release& release);

  /// Like the plain `fly`; `Aloft` if the limit of time or vertices was reached in the air. Each further parabola gets
  /// a vertex.
  ///
  /// @param watch  for barriers, null: none. A piece ends at a barrier that catches the block or breaks
  FlightEnd fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path,
                BarrierWatch* watch = nullptr);

  /// Applies drag and stems of a slide, at its end.
  void after_slide(const Motion& before, const Block& body, Motion& motion, Path& path);

 private:
  struct Site {
    DragRate drag;
    bool stems;
  };
  struct Piece;
  Site site_of(const Motion& motion, const Block& body) const;
  double longest_piece(const Site& site, const Motion& motion) const;
  bool in_a_stand(const PatchIndex& patch) const;  ///< whether one of its four cells is
  bool below_the_tops(const Vec3& position) const;
  bool meet_stem(const PlanWay& gone, const Block& body, Motion& motion);
  std::optional<FlightEnd> fly_clear(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path,
                                     BarrierWatch* watch);
  std::optional<BarrierMet> end_at_barrier(const BarrierWatch& watch, Piece& piece, FlightEnd& end, Motion& motion,
                                           PatchIndex& at, const Block& body, Path& path) const;
  FlightEnd fly_piece(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path,
                      BarrierWatch* watch);

  const World& world_;
  const Effects& effects_;
  std::optional<Stems> stems_;
};

}  // namespace talus
