// Slides across the borders of grounds with different friction.
#include <gtest/gtest.h>

#include <array>

#include "support/scenes.hpp"
#include "talus/physics/slide.hpp"

namespace talus {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kStopSpeed = 0.5;

/// A plane of 20 x 20 cells of 10 m that falls by 0.375 towards `heading`, one of the four axes.
Surface plane_towards(const Vec2& heading) {
  return Surface(test::terrain(test::grid_of(20, 20, 10.0, 10.0), [&](double x, double y) {
    return 500.0 - 0.375 * (heading.x() * (x - 100.0) + heading.y() * (y - 100.0));
  }));
}

/// Ground 0 before the middle of the terrain, ground 1 beyond it, seen along `heading`.
Cover two_grounds(const Grid& grid, const Vec2& heading, double tan_before, double tan_beyond) {
  Cover cover{{Ground{.tan_phi = tan_before}, Ground{.tan_phi = tan_beyond}}, Raster<std::uint8_t>(grid, 0)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (heading.dot(Vec2(grid.centre_x(column) - 100.0, grid.centre_y(row) - 100.0)) > 0.0)
        cover.zones.at(column, row) = 1;
  return cover;
}

struct SlideAcross {
  Motion motion;
  PatchIndex at;
  Path path;
  SlideEnd end;

  /// @param before  distance in plan from the middle of the terrain, against `heading` [m]; `beside`: across it
  SlideAcross(const Surface& surface, const Cover& cover, const Vec2& heading, double before, double beside,
              double speed, double diameter, const RollingResistance* resistance = nullptr) {
    const Vec2 place = Vec2(100.0, 100.0) - before * heading + beside * Vec2(-heading.y(), heading.x());
    at = surface.patch_at(place.x(), place.y());
    motion.position = {place.x(), place.y(), *surface.height(place.x(), place.y())};
    const double cos_b = 1.0 / std::hypot(1.0, 0.375);
    motion.velocity = {speed * cos_b * heading.x(), speed * cos_b * heading.y(), -0.375 * speed * cos_b};
    end = slide(surface, cover, motion, at, {diameter}, kStopSpeed, path, resistance);
  }
  double beyond(const Vec2& heading) const { return heading.dot(motion.position.head<2>() - Vec2(100.0, 100.0)); }
};

double pull(double tan_phi) {  // along the plane [m/s^2]
  return kGravity * (0.375 - tan_phi) / std::hypot(1.0, 0.375);
}

const std::array<Vec2, 4> kHeadings{Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)};

/// 5 degrees, then 60: v1^2 = v0^2 + 2 a1 s1 at the border, and beyond it the way (v1^2 - 0.5^2) / (-2 a2) to the stop
/// speed, whatever the diameter.
TEST(SlideAcrossABorder, StopsWhereTheFrictionBeyondHoldsIt) {
  const double tan_5 = std::tan(radians(5.0)), tan_60 = std::sqrt(3.0), cos_b = 1.0 / std::hypot(1.0, 0.375);
  for (const Vec2& heading : kHeadings) {
    const Surface surface = plane_towards(heading);
    const Cover cover = two_grounds(surface.grid(), heading, tan_5, tan_60);
    for (const double diameter : {1.0, 3.0, 5.0})
      for (const double before : {0.1, 0.5}) {
        const SlideAcross s(surface, cover, heading, before, 2.0, 3.0, diameter);
        const double v1_squared = 9.0 + 2.0 * pull(tan_5) * before / cos_b;
        const double way = (v1_squared - kStopSpeed * kStopSpeed) / (-2.0 * pull(tan_60));
        EXPECT_EQ(s.end, SlideEnd::Stopped);
        EXPECT_NEAR(s.beyond(heading), way * cos_b, 1e-6) << diameter << ' ' << before;
        EXPECT_NEAR(s.beyond(heading), before == 0.1 ? 0.350 : 0.435, 0.0005);  // by hand
        ASSERT_EQ(s.path.spans.size(), 2U);
        EXPECT_NEAR(s.path.spans[0].rise_to, std::sqrt(v1_squared), 1e-5);
        EXPECT_EQ(s.path.spans[1].rise_from, s.path.spans[0].rise_to);
      }
  }
}

/// A block that starts on the border, or off it by the last digit, has the friction of the ground that it moves into.
TEST(SlideAcrossABorder, FromTheBorderItHasTheFrictionAhead) {
  const double cos_b = 1.0 / std::hypot(1.0, 0.375);
  for (const Vec2& heading : kHeadings) {
    const Surface surface = plane_towards(heading);
    for (const double tan_beyond : {0.1, 0.8})
      for (const double before : {0.0, 2e-14, -2e-14}) {
        const Cover cover = two_grounds(surface.grid(), heading, 0.4, tan_beyond);
        const SlideAcross s(surface, cover, heading, before, 3.0, 3.0, 1.0);
        EXPECT_EQ(s.end, SlideEnd::NextAsperity);
        EXPECT_NEAR(s.motion.velocity.squaredNorm(), 9.0 + 2.0 * pull(tan_beyond), 1e-6);
        EXPECT_NEAR(s.beyond(heading), cos_b, 1e-6);
        ASSERT_EQ(s.path.spans.size(), 1U);
      }
  }
}

/// Up across the border into higher friction, to rest on steep ground, and down again: friction turns with the motion,
/// and each part has the friction of its own ground.
TEST(SlideAcrossABorder, UpAndDownAgain) {
  const Vec2 up(-1.0, 0.0), down(1.0, 0.0);
  const Surface surface = plane_towards(down);
  const Cover cover = two_grounds(surface.grid(), up, 0.1, 0.3);
  const double climb_a = kGravity * (0.375 + 0.1) / std::hypot(1.0, 0.375),
               climb_b = kGravity * (0.375 + 0.3) / std::hypot(1.0, 0.375);
  const double cos_b = 1.0 / std::hypot(1.0, 0.375), before = 0.2 / cos_b, diameter = 2.0, v0 = 2.5;
  const double border_squared = v0 * v0 - 2.0 * climb_a * before, above = border_squared / (2.0 * climb_b);
  const double back_squared = 2.0 * pull(0.3) * above;
  const double below = diameter - before - 2.0 * above;
  ASSERT_GT(above, 0.1);
  ASSERT_GT(below, 0.5);
  SlideAcross s(surface, cover, up, 0.2, 3.0, 0.0, 0.0);  // puts the block there
  s.motion.velocity = {-v0 * cos_b, 0.0, 0.375 * v0 * cos_b};
  s.path.clear();
  s.end = slide(surface, cover, s.motion, s.at, {diameter}, kStopSpeed, s.path);
  EXPECT_EQ(s.end, SlideEnd::NextAsperity);
  EXPECT_NEAR(s.motion.velocity.squaredNorm(), back_squared + 2.0 * pull(0.1) * below, 1e-3);
  EXPECT_NEAR(-s.beyond(up) / cos_b, below, 1e-3);
}

/// Along the border: the friction of either side, in one piece per patch.
TEST(SlideAcrossABorder, AlongTheBorder) {
  const Vec2 heading(1.0, 0.0), side(0.0, 1.0);
  const Surface surface = plane_towards(heading);
  const Cover cover = two_grounds(surface.grid(), side, 0.1, 0.2);
  for (const double beside : {0.0, 1e-14, -1e-14}) {
    const SlideAcross s(surface, cover, heading, 8.0, beside, 3.0, 4.0);
    EXPECT_EQ(s.end, SlideEnd::NextAsperity);
    const double v_squared = s.motion.velocity.squaredNorm();
    EXPECT_GE(v_squared, 9.0 + 8.0 * pull(0.2) - 1e-6);
    EXPECT_LE(v_squared, 9.0 + 8.0 * pull(0.1) + 1e-6);
    EXPECT_LE(s.path.spans.size(), 2U);
  }
}

/// Rolling resistance in an area ends at its border, too, as zones do. Where it acts everywhere, no piece ends at a
/// cell.
TEST(SlideAcrossABorder, RollingResistanceOfAnArea) {
  const Vec2 heading(1.0, 0.0);
  const Surface surface = plane_towards(heading);
  const Cover one{{Ground{.tan_phi = 0.1}}, {}}, two = two_grounds(surface.grid(), heading, 0.1, 0.1);
  RollingResistance in_cells{.coefficient = 0.6, .where = {}}, in_zone = in_cells, everywhere = in_cells;
  in_cells.where.mask = two.zones;
  in_zone.where.zones = {0, 1};
  const double cos_b = 1.0 / std::hypot(1.0, 0.375), first = 0.5 / cos_b;
  const double v_squared = 25.0 + 2.0 * pull(0.1) * first + 2.0 * pull(0.7) * (2.0 - first);
  const SlideAcross cells(surface, one, heading, 0.5, 2.0, 5.0, 2.0, &in_cells),
      zone(surface, two, heading, 0.5, 2.0, 5.0, 2.0, &in_zone),
      all(surface, two, heading, 0.5, 2.0, 5.0, 2.0, &everywhere);
  EXPECT_NEAR(cells.motion.velocity.squaredNorm(), v_squared, 1e-5);
  EXPECT_NEAR(zone.motion.velocity.squaredNorm(), v_squared, 1e-5);
  EXPECT_NEAR(all.motion.velocity.squaredNorm(), 25.0 + 4.0 * pull(0.7), 1e-5);
  EXPECT_EQ(all.path.spans.size(), 1U);
}

/// Along the bottom of a V, an edge between patches: g (sin b - tan(phi) cos(beta of the walls)) with the friction of
/// each ground up to its border.
TEST(SlideAcrossABorder, OnTheBottomOfAGully) {
  const Surface surface(test::terrain(test::grid_of(40, 21, 10.0, 10.0),
                                      [&](double x, double y) { return 800.0 - x + 2.0 * std::abs(y - 105.0); }));
  const Cover cover = two_grounds(surface.grid(), {1.0, 0.0}, 0.2, 1.5);
  const auto a = [](double tan_phi) { return kGravity * (std::sqrt(0.5) - tan_phi / std::sqrt(6.0)); };
  Motion motion;
  motion.position = {99.0, 105.0, *surface.height(99.0, 105.0)};
  motion.velocity = {3.0, 0.0, -3.0};
  PatchIndex at = surface.patch_at(99.0, 105.0);
  Path path;
  EXPECT_EQ(slide(surface, cover, motion, at, {4.0}, kStopSpeed, path), SlideEnd::NextAsperity);
  const double first = std::sqrt(2.0), v_squared = 18.0 + 2.0 * a(0.2) * first + 2.0 * a(1.5) * (4.0 - first);
  EXPECT_NEAR(motion.velocity.squaredNorm(), v_squared, 0.05);
}

/// Any ground in any cell, slow blocks on borders and corners: bounded, and no piece goes farther beyond a border than
/// the error of a piece.
TEST(SlideAcrossABorder, IsBoundedOnAnyPatchworkOfGrounds) {
  test::Numbers numbers(9);
  for (int scene = 0; scene < 20; ++scene) {
    const double cell = numbers.uniform(0.3, 6.0), rough = scene % 3 * 0.3 * cell;
    const Surface surface(
        test::terrain(test::grid_of(60, 60, cell, cell),
                      [&](double x, double y) { return 500.0 - 0.8 * x + 0.2 * y + numbers.uniform(0.0, rough); }),
        scene % 2 == 0 ? SurfaceKind::Bilinear : SurfaceKind::Creased);
    Cover cover{{Ground{.tan_phi = 0.1}, Ground{.tan_phi = 0.4}, Ground{.tan_phi = 0.7}},
                Raster<std::uint8_t>(surface.grid(), 0)};
    for (std::uint8_t& zone : cover.zones.values) zone = static_cast<std::uint8_t>(numbers.uniform(0.0, 2.99));
    for (int i = 0; i < 200; ++i) {
      const double x = cell * (i % 3 == 0 ? 20 + i % 17 : numbers.uniform(20, 40)),
                   y = cell * (i % 4 == 0 ? 20 + i % 13 : numbers.uniform(20, 40)),
                   diameter = numbers.uniform(0.3, 3.0);
      Motion motion;
      motion.position = {x, y, *surface.height(x, y)};
      const double slow = i % 5 == 0 ? 0.01 : 1.0;
      motion.velocity = {i % 6 == 0 ? 0.0 : slow * numbers.uniform(-2, 4),
                         i % 7 == 0 ? 0.0 : slow * numbers.uniform(-4, 4), 0.0};
      PatchIndex at = surface.patch_at(x, y);
      Path path;
      slide(surface, cover, motion, at, {diameter}, kStopSpeed, path);
      EXPECT_LT(path.spans.size(), 500U) << scene << ' ' << i;
      EXPECT_TRUE(motion.position.allFinite() && motion.velocity.allFinite());
      for (const Span& s : path.spans) {
        const int column = s.patch.column, row = s.patch.row;
        const auto zone = [&](int east, int north) { return cover.zones.at(column + east, row + north); };
        if (zone(0, 0) == zone(1, 0) && zone(0, 0) == zone(0, 1) && zone(0, 0) == zone(1, 1)) continue;
        const double past_x = std::min(std::abs(s.p_from - 0.5F), std::abs(s.p_to - 0.5F)) * cell,
                     past_y = std::min(std::abs(s.q_from - 0.5F), std::abs(s.q_to - 0.5F)) * cell;
        if ((s.p_from < 0.5F) != (s.p_to < 0.5F)) EXPECT_LT(past_x, 0.005 * diameter + 1e-5) << scene << ' ' << i;
        if ((s.q_from < 0.5F) != (s.q_to < 0.5F)) EXPECT_LT(past_y, 0.005 * diameter + 1e-5) << scene << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace talus
