#include "talus/fit/diagnose/candidates.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/campaigns.hpp"
#include "talus/fit/diagnose/residual.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::test {
namespace {

/// Blocks of two days, each measured, with a sample halfway down; a second screen that none crossed.
Campaign measured_campaign() {
  Campaign c = campaign_on_slope(30);
  measure(c, model_of_slope(), 5);
  c.screens.push_back({"S2", {{{100.0, 0.0}, {100.0, 140.0}}}});
  for (MeasuredBlock& b : c.blocks) b.passages.resize(2);
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    c.blocks[b].day = 1 + static_cast<int>(b % 2);
    c.blocks[b].samples.push_back({60.0, c.blocks[b].y, 0.0, 52.0, 8.0, 9.0});
  }
  return c;
}

std::vector<BlockRuns> fitting_runs(const Campaign& c, std::uint32_t trials) {
  return observe(c, model_of_slope(), {trials, 1, 0, 0, fitting_rows(c), {}});
}

/// Everything in which candidates differ.
std::vector<std::string> described(const Campaign& c) {
  std::vector<std::string> list;
  const auto runs = fitting_runs(c, 20);
  for (const Candidate& candidate : candidates_of(c, model_of_slope(), runs, {}, {})) {
    Model m = with(model_of_slope(), candidate, Eigen::VectorXd::Ones(std::ssize(candidate.parameters)));
    list.push_back(candidate.effect + ' ' + candidate.where + ' ' + std::to_string(candidate.from));
    if (!m.barriers.empty()) list.back() += ' ' + std::to_string(m.barriers[0].lines[0][0].x());
    list.back() += ' ' + std::to_string(m.effects.block_mass.reference_diameter);
  }
  return list;
}

TEST(Candidates, HangOnNothingThatWasHeldOut) {
  Campaign c = measured_campaign();
  const std::vector<std::string> before = described(c);
  ASSERT_GT(before.size(), 40U);
  for (MeasuredBlock& b : c.blocks) {
    if (!b.holdout) continue;
    b.x += 40.0;
    b.mass *= 10.0;
    b.day = 7;
    b.axes = {3.0, 1.0, 0.5};
    b.stop = Eigen::Vector2d(300.0, 10.0);
    b.stop_mass = 0.1 * b.mass;
    b.passages[0].reset();
    b.passages[1] = Passage{5.0, 1.0, 5.0};
    b.samples.clear();
  }
  EXPECT_EQ(described(c), before);
  const ResidualSpace space(c, fitting_runs(c, 20), {});
  for (const Observable& o : space.observables()) {
    EXPECT_NE(o.name, "mass") << "only held-out blocks broke";
    EXPECT_NE(o.name, "crossed S2") << "only held-out blocks crossed it";
  }
}

TEST(Candidates, ADayThatIsNotGivenIsNoDay) {
  Campaign c = measured_campaign();
  for (std::size_t b = 0; b < c.blocks.size(); b += 3) c.blocks[b].day = 0;
  for (const Candidate& candidate : candidates_of(c, model_of_slope(), fitting_runs(c, 20), {}, {}))
    EXPECT_NE(candidate.where, "day 0");
}

/// A file may hold each number of an effect at both ends of its search, so that the file of a fit can be read again.
TEST(Candidates, StayWithinTheBoundsOfTheRegistry) {
  Campaign c = measured_campaign();
  for (MeasuredBlock& b : c.blocks) b.mass = 5000.0, b.axes = {3.0, 2.0, 1.0};
  std::set<std::string> seen;
  for (const Candidate& candidate : candidates_of(c, model_of_slope(), fitting_runs(c, 20), {}, {}))
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
      for (const double value : {candidate.parameters[i].lower, candidate.parameters[i].upper, 1e-9}) {
        Model m = model_of_slope();
        candidate.prepare(m);
        if (value >= candidate.parameters[i].lower) candidate.parameters[i].set(m, value);
        for (const EffectEntry& entry : effect_entries())
          for (const EffectField& field : entry.fields())
            EXPECT_EQ(fault_of(field, field.get(m.effects)), std::nullopt) << field.key << ' ' << value;
        seen.insert(candidate.effect);
      }
  for (const EffectEntry& entry : effect_entries())
    EXPECT_TRUE(seen.contains(std::string(entry.name)) || entry.sought == Sought::Nowhere) << entry.name;
}

/// The search of vegetation-drag goes to 3 kg/s per kg of the median block, and no farther than 5000 kg/s, the bound of
/// a file. docs/effects.md, "vegetation-drag".
TEST(Candidates, SearchInMultiplesOfTheMedianBlock) {
  Campaign c = measured_campaign();
  for (const auto& [mass, most] : {std::pair{200.0, 600.0}, {1000.0, 3000.0}, {5000.0, 5000.0}}) {
    for (MeasuredBlock& b : c.blocks) b.mass = b.holdout ? 1e5 : mass;
    c.blocks[1].mass *= 10.0;  // the median does not see it
    int found = 0;
    for (const Candidate& candidate : candidates_of(c, model_of_slope(), fitting_runs(c, 20), {}, {}))
      for (const Parameter& p : candidate.parameters)
        if (p.key == "effects.vegetation-drag.coefficient") {
          ++found;
          EXPECT_EQ(p.lower, 0.0);
          EXPECT_NEAR(p.upper, most, 1e-9 * most) << mass;
        }
    EXPECT_GT(found, 0);
  }
}

/// Results list the candidates in this order, whatever the order of the registry. New effects may stand anywhere.
TEST(Candidates, StandInTheOrderOfTheirTurns) {
  Campaign c = measured_campaign();
  for (MeasuredBlock& b : c.blocks) b.axes = {3.0, 2.0, 1.0};
  const std::vector<std::string> order{"vegetation-drag", "forest-stems",    "soft-ground",     "rolling-resistance",
                                       "air-drag",        "block-shape",     "block-mass",      "wet-ground",
                                       "fragmentation",   "instrument-bias", "undeclared-zone", "undeclared-barrier"};
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates_of(c, model_of_slope(), fitting_runs(c, 20), {}, {}))
    if (std::ranges::find(order, candidate.effect) != order.end() &&
        (names.empty() || names.back() != candidate.effect))
      names.push_back(candidate.effect);
  EXPECT_EQ(names, order);
}

TEST(Residual, OfATrialHasTheGapsOfItsBlock) {
  Campaign c = measured_campaign();
  c.blocks[0].stop.reset();
  c.blocks[1].passages[0] = Passage{kNotGiven, 1.0, 5.0};
  c.blocks[3].passages[0].reset();  // did not cross; all quantities of a trial that does count as measured
  for (MeasuredBlock& b : c.blocks) b.samples[0].spin = kNotGiven;
  const auto runs = fitting_runs(c, 40);
  const ResidualSpace space(c, runs, {});
  std::vector<std::string> names;
  for (const Observable& o : space.observables()) names.push_back(o.name);
  const auto at = [&names](const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  EXPECT_EQ(at("sample spin early"), std::ssize(names)) << "no block has it";
  std::array<int, 4> stops{}, speeds{}, jumps{};
  for (const std::size_t b : {0U, 1U, 3U})
    for (std::size_t t = 0; t < 40; ++t) {
      const Residual r = space.of_trial(b, runs[b], t);
      stops[b] += std::isnan(r[at("runout")]) ? 0 : 1;
      speeds[b] += std::isnan(r[at("speed S1")]) ? 0 : 1;
      jumps[b] += std::isnan(r[at("jump S1")]) ? 0 : 1;
    }
  EXPECT_EQ(stops[0], 0);
  EXPECT_GT(stops[1], 20);
  EXPECT_EQ(speeds[1], 0);
  EXPECT_GT(jumps[1], 20);
  EXPECT_EQ(speeds[3], jumps[3]);
  EXPECT_GT(speeds[3], 20);
}

TEST(Candidates, OffChangesNoBit) {
  Campaign c = slope_campaign(6);
  const Model model = model_of_preset(c, "upper-talus-3d");
  measure(c, model, 3);
  for (MeasuredBlock& b : c.blocks) b.samples.push_back({b.x, b.y - 20.0, 0.0, 20.0, 8.0, 9.0});
  const auto runs = observe(c, model, {20, 1, 0, 0, {}, {}});
  const auto list = candidates_of(c, model, runs, {}, {});
  ASSERT_GT(list.size(), 20U);
  for (const Candidate& candidate : list) {
    Model off = with(model, candidate, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidate.parameters.size())));
    const auto same = observe(c, off, {20, 1, 0, 0, {}, {}});
    for (std::size_t b = 0; b < runs.size(); ++b)
      for (std::size_t t = 0; t < 20; ++t) {
        const auto same_bits = [&](const std::vector<double>& one, const std::vector<double>& other) {
          return one[t] == other[t] || (std::isnan(one[t]) && std::isnan(other[t]));
        };
        ASSERT_TRUE(same_bits(same[b].x, runs[b].x) && same_bits(same[b].y, runs[b].y) &&
                    same_bits(same[b].screens[0].speed, runs[b].screens[0].speed) &&
                    same_bits(same[b].screens[0].jump, runs[b].screens[0].jump) &&
                    same_bits(same[b].screens[0].spin, runs[b].screens[0].spin) &&
                    same_bits(same[b].samples[0].speed, runs[b].samples[0].speed) &&
                    same_bits(same[b].samples[0].spin, runs[b].samples[0].spin))
            << candidate.effect << ' ' << candidate.where;
      }
  }
}

TEST(Candidates, ABarrierAboveEveryJumpLetsNothingPassAndABiasMultiplies) {
  Campaign c = slope_campaign(6);
  c.error = {};
  const Model model = model_of_preset(c, "upper-talus-3d");
  const auto runs = observe(c, model, {20, 1, 0, 0, {}, {}});
  Model walled = model;
  walled.barriers.push_back({"wall", {{{0.0, 100.0}, {120.0, 100.0}}}, 1e9, std::numeric_limits<double>::infinity()});
  Model high = model;
  high.bias.assign(2, Bias{});
  high.bias[instrument_of_screen(0)].speed = 0.25;
  const auto caught = observe(c, walled, {20, 1, 0, 0, {}, {}}), read = observe(c, high, {20, 1, 0, 0, {}, {}});
  for (std::size_t b = 0; b < runs.size(); ++b)
    for (std::size_t t = 0; t < 20; ++t) {
      EXPECT_TRUE(std::isnan(caught[b].screens[0].speed[t]));  // the screen is behind the barrier
      if (caught[b].end[t] == End::Caught) {
        EXPECT_NEAR(caught[b].y[t], 100.0, 1e-3 + 1e-6);  // a millimetre before it
      }
      if (!std::isnan(runs[b].screens[0].speed[t])) {
        EXPECT_DOUBLE_EQ(read[b].screens[0].speed[t], 1.25 * runs[b].screens[0].speed[t]);
      }
    }
}

TEST(Candidates, ABandOfOtherGroundCountsWithItsZone) {
  const Campaign c = slope_campaign(2);
  std::vector<BlockRuns> runs(1);
  runs[0].trials = 10;
  runs[0].zone_hits = {0, 10};  // the zone, and the zone in the band
  EXPECT_EQ(touched_zones(c, runs), std::vector<bool>{true});
}

}  // namespace
}  // namespace talus::test
