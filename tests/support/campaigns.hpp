#pragma once
#include "scenarios.hpp"
#include "talus/fit/campaign/observe.hpp"
#include "talus/fit/score/score.hpp"

/// Small campaigns by hand for the tests of `fit`.
namespace talus::test {

/// Blocks that were released side by side at the top of a slope of 42 degrees with bumps, which a screen crosses at
/// x = 90 m and which ends in a flat floor at x = 120 m. Every third is held out. Nothing is measured yet.
inline Campaign campaign_on_slope(std::size_t blocks) {
  Numbers numbers(11);
  Campaign c;
  c.name = "slope";
  c.surface = Surface(terrain(grid_of(160, 70, 2.0, 2.0), [&](double x, double) {
    return 200.0 - 0.9 * std::min(x, 120.0) + numbers.uniform(-0.3, 0.3);
  }));
  c.zone_names = {"default"};
  c.screens = {{"S1", {{{90.0, 0.0}, {90.0, 140.0}}}}};
  c.error = {0.3, 0.03, 0.1, 0.05};
  for (std::size_t i = 0; i < blocks; ++i) {
    MeasuredBlock b;
    b.id = "b" + std::to_string(i);
    b.stream = stream_of_name(b.id);
    b.x = 8.0;
    b.y = 30.0 + 70.0 * static_cast<double>(i) / static_cast<double>(blocks);
    b.mass = 500.0 + 20.0 * static_cast<double>(i);
    b.velocity = Vec3(1.0, 0.0, 0.0);
    b.axes.setConstant(equivalent_diameter(b.mass, b.density));
    b.holdout = i % 3 == 2;
    b.passages.resize(1);
    c.blocks.push_back(std::move(b));
  }
  return c;
}

/// A slope of 40 degrees that runs out on a plain; blocks of many sizes and shapes, one screen. Nothing measured yet.
inline Campaign slope_campaign(int blocks) {
  Numbers numbers(5);
  Campaign c;
  c.name = "slope";
  c.surface = Surface(terrain(grid_of(60, 110, 2.0, 2.0), [](double, double y) {
    return 0.84 * std::max(0.0, y - 80.0) + 0.1 * std::min(y, 80.0);
  }));
  c.zone_names = {"default"};
  c.screens = {{"S1", {{{0.0, 90.0}, {120.0, 90.0}}}}};
  c.error = {0.3, 0.03, 0.1, 0.05};
  for (int i = 0; i < blocks; ++i) {
    MeasuredBlock b;
    b.id = "b" + std::to_string(i);
    b.stream = stream_of_name(b.id);
    b.x = numbers.uniform(40.0, 80.0);
    b.y = numbers.uniform(185.0, 200.0);
    b.velocity = {0.0, -1.0, 0.0};
    b.mass = std::exp(numbers.uniform(std::log(60.0), std::log(4000.0)));
    b.axes = {numbers.uniform(1.2, 2.2), 1.1, 1.0};
    b.day = 1 + i % 3;
    b.passages.resize(1);
    c.blocks.push_back(b);
  }
  return c;
}

/// The ground of the rough slope.
inline Model model_of_slope() {
  Model model;
  model.grounds = rough_slope(1, 1).cover.grounds;
  return model;
}

/// Gives every block the observations of trial 0 of another seed: measured data of a known model.
inline void measure(Campaign& c, const Model& model, std::uint64_t seed) {
  ObserveOptions once;
  once.trials = 1;
  once.seed = seed;
  const std::vector<BlockRuns> runs = observe(c, model, once);
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    const BlockRuns& r = runs[b];
    if (!std::isnan(r.x[0])) c.blocks[b].stop = Eigen::Vector2d(r.x[0], r.y[0]);
    for (std::size_t s = 0; s < r.screens.size(); ++s)
      if (!std::isnan(r.screens[s].speed[0]))
        c.blocks[b].passages[s] = Passage{r.screens[s].speed[0], r.screens[s].jump[0], r.screens[s].spin[0]};
  }
}

/// A score of one group: one row of each block.
inline Score score_of_rows(const std::vector<double>& values) {
  Score s;
  s.groups = {{"g", 0.0, static_cast<std::uint32_t>(values.size())}};
  for (std::uint32_t b = 0; b < values.size(); ++b) s.rows.push_back({0, b, values[b]});
  for (const double value : values) s.groups[0].score += value / static_cast<double>(values.size());
  s.total = s.groups[0].score;
  return s;
}

}  // namespace talus::test
