#include <gtest/gtest.h>

#include <functional>

#include "support/slopes.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;
using test::same_bits;

Hillside rough_hill() {
  test::Numbers numbers(5);
  Hillside hill(0.0);
  hill.surface = Surface(test::terrain(test::grid_of(120, 80, 4.0, 4.0), [&](double x, double) {
    return 1000.0 - 0.8 * std::min(x, 240.0) - 0.1 * std::max(0.0, x - 240.0) + numbers.uniform(-0.5, 0.5);
  }));
  hill.cover.grounds[0] = {.theta_scale = 0.6, .psi_scale = 0.5, .En50 = 5.0, .shape_max = 1.4};
  return hill;
}

Release release_of(std::uint32_t block) {
  Release release = block_at({40.0, 160.0, 975.0}, {2.0, 0.3, 0.0}, 1.0, block);
  release.body.axes = Vec3(1.6, 1.2, 1.0);
  release.day = 3;
  return release;
}

/// Strengths at which each effect shows on this slope.
Effects all_on() {
  Effects e;
  e.vegetation_drag.coefficient = 300.0;
  e.forest_stems.density = 300.0;
  e.air_drag.coefficient = 1.0;
  e.block_shape.lateral = 0.5, e.block_shape.loss = 0.3;
  e.block_mass.roughness = 0.5, e.block_mass.stiffness = 0.5, e.block_mass.reference_diameter = 2.0;
  e.wet_ground.softening = 0.5, e.wet_ground.drag = 0.5, e.wet_ground.days = {3};
  e.soft_ground.drag = 2.0;
  e.rolling_resistance.coefficient = 0.4;
  e.fragmentation.threshold = 60.0;
  return e;
}

TEST(Effects, AtTheirOffValuesChangeNoBit) {
  Hillside plain = rough_hill(), acting = rough_hill();
  plain.acting = false;
  acting.effects.wet_ground.days = {3};
  for (std::uint32_t block = 0; block < 100; ++block)
    ASSERT_TRUE(same_bits(plain.run(release_of(block)), acting.run(release_of(block)))) << block;
}

TEST(Effects, EachOffValueTakesItsStrengthAway) {  // over the table that scenario, calibration and diagnosis use
  int strengths = 0;
  for (const auto& field : effect_fields()) {
    if (std::isnan(field.off)) continue;
    ++strengths;
    const std::string key(field.key), effect = key.substr(0, key.find('.'));
    Hillside without = rough_hill(), off = rough_hill(), on = rough_hill();
    without.acting = false;
    off.effects.wet_ground.days = on.effects.wet_ground.days = {3};
    off.effects.block_mass.reference_diameter = on.effects.block_mass.reference_diameter = 2.0;
    field.set(off.effects, field.off);
    field.set(on.effects, field.get(all_on()));
    EXPECT_FALSE(off.effects.any()) << key;
    EXPECT_TRUE(on.effects.any()) << key;
    bool shows = false;
    for (std::uint32_t block = 0; block < 40; ++block) {
      const Path path = without.run(release_of(block));
      ASSERT_TRUE(same_bits(path, off.run(release_of(block)))) << key;
      shows = shows || !same_bits(path, on.run(release_of(block)));
    }
    EXPECT_TRUE(shows) << key;
  }
  EXPECT_EQ(strengths, 12);
}

TEST(Effects, OutsideTheirPlaceChangeNoImpact) {  // flights are cut in pieces there: equal but for rounding
  Hillside plain = rough_hill(), acting = rough_hill();
  plain.acting = false;
  plain.cover.grounds.push_back({});
  acting.cover.grounds.push_back({});
  acting.effects = all_on();
  acting.effects.air_drag.coefficient = 0.0;  // acts everywhere
  acting.effects.fragmentation.threshold = 60.0;
  const Raster<std::uint8_t> nowhere(acting.surface.grid(), 0);
  Effects& e = acting.effects;
  for (EffectArea* where : {&e.vegetation_drag.where, &e.forest_stems.where, &e.block_shape.where, &e.block_mass.where,
                        &e.wet_ground.where})
    where->zones = {0, 1};
  for (EffectArea* where : {&e.soft_ground.where, &e.rolling_resistance.where, &e.fragmentation.where})
    where->mask = nowhere;
  e.vegetation_drag.coefficient = e.forest_stems.density = 0.0;  // those two: in the tests of drag
  for (std::uint32_t block = 0; block < 40; ++block)
    ASSERT_TRUE(same_bits(plain.run(release_of(block)), acting.run(release_of(block)))) << block;
}

TEST(Effects, DoNotShiftTheDrawsOfImpacts) {  // stems without strength: the same impacts, to rounding
  Hillside plain = rough_hill(), acting = rough_hill();
  plain.acting = false;
  acting.effects.forest_stems = {.density = 500.0, .species_factor = 1e-300, .where = {}};
  for (std::uint32_t block = 0; block < 20; ++block) {
    const Path a = plain.run(release_of(block)), b = acting.run(release_of(block));
    std::vector<Motion> left, right;
    bool stem = false;
    for (const Vertex& v : a.vertices)
      if (v.event == Event::Impact) left.push_back(v.motion);
    for (const Vertex& v : b.vertices) {
      stem = stem || v.event == Event::Stem;
      if (v.event == Event::Impact) right.push_back(v.motion);
    }
    EXPECT_TRUE(stem);
    for (std::size_t i = 0; i < 5 && i < left.size() && i < right.size(); ++i)
      ASSERT_LT((left[i].velocity - right[i].velocity).norm(), 1e-6) << block << ' ' << i;
  }
}

}  // namespace
}  // namespace talus
