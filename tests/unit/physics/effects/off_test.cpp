#include <gtest/gtest.h>

#include <functional>

#include "support/slopes.hpp"

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
  Release release = block_at({40.0, 160.0, 975.0}, {2.0, 0.3, 0.0}, 1.4, block);
  release.body.axes = Vec3(1.6, 1.2, 1.0);
  release.day = 3;
  return release;
}

/// Sets a strength to the amount that `diagnose` counts as noticed; without one, to 1.
void notice(Effects& effects, const EffectField& field) {
  const SearchRange range = field.search.value_or(SearchRange{0.0, 1.0, 1.0});
  const double scale = range.times == Typical::BlockMass ? release_of(0).body.mass : 1.0;
  field.set(effects, range.inverse_unit.empty() ? scale * range.noticed : 1.0 / range.noticed);
}

/// An effect that acts on some days acts on that of the releases.
Effects on_the_day() {
  Effects effects;
  for (const EffectEntry& entry : effect_entries())
    if (std::vector<int>* days = entry.days(effects)) *days = {3};
  return effects;
}

Effects all_on() {
  Effects effects = on_the_day();
  for (const EffectEntry& entry : effect_entries())
    for (const EffectField& field : entry.fields())
      if (field.is_strength()) notice(effects, field);
  return effects;
}

TEST(Effects, AtTheirOffValuesChangeNoBit) {
  Hillside plain = rough_hill(), acting = rough_hill();
  plain.acting = false;
  acting.effects = on_the_day();
  for (std::uint32_t block = 0; block < 100; ++block)
    ASSERT_TRUE(same_bits(plain.run(release_of(block)), acting.run(release_of(block)))) << block;
}

/// A strength at its off value changes no bit. One that is on changes a path; else the engine does not use it.
TEST(Effects, EachStrengthActsAndItsOffValueTakesItAway) {
  for (const EffectEntry& entry : effect_entries())
    for (const EffectField& field : entry.fields()) {
      if (!field.is_strength()) continue;
      Hillside without = rough_hill(), off = rough_hill(), on = rough_hill();
      without.acting = false;
      off.effects = on.effects = on_the_day();
      field.set(off.effects, field.off);
      notice(on.effects, field);
      EXPECT_FALSE(off.effects.any()) << field.key;
      EXPECT_TRUE(on.effects.any()) << field.key;
      bool shows = false;
      for (std::uint32_t block = 0; block < 40; ++block) {
        const Path path = without.run(release_of(block));
        ASSERT_TRUE(same_bits(path, off.run(release_of(block)))) << field.key;
        shows = shows || !same_bits(path, on.run(release_of(block)));
      }
      EXPECT_TRUE(shows) << field.key;
    }
}

TEST(Effects, OutsideTheirPlaceChangeNoImpact) {  // flights are cut in pieces there: equal but for rounding
  Hillside plain = rough_hill(), acting = rough_hill();
  plain.acting = false;
  plain.cover.grounds.push_back({});
  acting.cover.grounds.push_back({});
  acting.effects = all_on();
  const Raster<std::uint8_t> nowhere(acting.surface.grid(), 0);
  Effects& e = acting.effects;
  bool by_zone = true;
  for (const EffectEntry& entry : effect_entries()) {
    if (EffectArea* area = entry.area(e)) {
      if (by_zone)
        area->zones = {0, 1};
      else
        area->mask = nowhere;
      by_zone = !by_zone;
    } else {
      for (const EffectField& field : entry.fields())
        if (field.is_strength()) field.set(e, field.off);  // acts everywhere
    }
  }
  e.vegetation_drag.coefficient = e.forest_stems.density = 0.0;  // for vegetation drag see drag_test
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
