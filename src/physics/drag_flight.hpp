#pragma once
#include <optional>

#include "talus/physics/effects/damped_fall.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// Flight through vegetation, air and stems, in pieces of constant drag rate: the parabola over the patches that ends
/// where the damped fall ends, then the velocity of the damped fall. docs/effects.md, "Flight with drag".
///
/// A piece is so short that the block goes at most one cell and drag takes at most 4 % of its speed. Linear drag is
/// exact; of quadratic drag the rate is that of the middle of the piece, and the speed errs by less than 1e-3 of itself
/// in it. A piece lasts 0.01 s at least, so that a block stuck in the bushes ends.
class DragFlight {
 public:
  DragFlight(const World& world, const Release& release);

  /// As the plain `fly`; `Aloft` where the time limit was reached in the air. Further parabolas get a vertex each.
  Outcome fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path);

  /// Drag and stems of a slide, at its end.
  void after_slide(const Motion& before, Motion& motion, const Block& body);

 private:
  struct Site {
    DragRate drag;
    bool stems;
  };
  Site site_of(const Motion& motion, const Block& body) const;
  double longest_piece(const Site& site, const Motion& motion) const;
  bool in_a_stand(const PatchIndex& patch) const;  ///< one of its four cells
  std::optional<Outcome> fly_clear(Motion& motion, PatchIndex& at, bool grounded, Path& path) const;
  Outcome fly_piece(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path);

  const World& world_;
  const Effects& effects_;
  std::optional<Stems> stems_;
};

}  // namespace talus
