#include "talus/fit/campaign/observe.hpp"

#include "support/campaigns.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/screens/screens.hpp"

namespace talus::test {
namespace {

void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
}

void expect_same(const BlockRuns& a, const BlockRuns& b) {
  expect_same(a.x, b.x);
  expect_same(a.y, b.y);
  for (std::size_t s = 0; s < a.screens.size(); ++s) {
    expect_same(a.screens[s].speed, b.screens[s].speed);
    expect_same(a.screens[s].jump, b.screens[s].jump);
    expect_same(a.screens[s].spin, b.screens[s].spin);
  }
  EXPECT_EQ(a.impacts, b.impacts);
  EXPECT_EQ(a.ends, b.ends);
  EXPECT_EQ(a.zone_hits, b.zone_hits);
}

TEST(Observe, SameBitsForAnyNumberOfThreadsAndChoiceOfBlocks) {
  const Campaign c = campaign_on_slope(7);
  ObserveOptions one, three;
  one.trials = three.trials = 70;
  one.threads = 1;
  three.threads = 3;
  three.blocks = {false, true, false, true, false, false, true};
  const auto a = observe(c, model_of_slope(), one), b = observe(c, model_of_slope(), three);
  for (std::size_t i = 0; i < 7; ++i) {
    if (three.blocks[i])
      expect_same(a[i], b[i]);
    else
      EXPECT_EQ(b[i].trials, 0U);
  }
}

TEST(Observe, SameBitsForAnyNumberOfLanes) {
  const Campaign c = campaign_on_slope(7);
  for (const std::uint32_t most_vertices : {Effort{}.most_vertices, 70U}) {
    ObserveOptions one;
    one.trials = 70;
    one.lanes = 1;
    one.effort.most_vertices = most_vertices;
    const auto a = observe(c, model_of_slope(), one);
    for (const int lanes : {4, 8}) {
      if (lanes > most_lanes()) continue;
      ObserveOptions more = one;
      more.lanes = lanes;
      const auto b = observe(c, model_of_slope(), more);
      for (std::size_t i = 0; i < 7; ++i) expect_same(a[i], b[i]);
    }
  }
}

/// The random numbers of a block follow from its id, and those of its measurement at a screen from the screen's.
TEST(Observe, SameBitsWhateverStandsBeside) {
  const Campaign c = campaign_on_slope(7);
  Campaign other = c;
  std::ranges::reverse(other.blocks);
  other.blocks.erase(other.blocks.begin() + 2);
  other.blocks.back().id = "renamed";
  other.screens.insert(other.screens.begin(), {"S0", {{{80.0, 0.0}, {80.0, 140.0}}}});
  ObserveOptions options;
  options.trials = 20;
  const auto a = observe(c, model_of_slope(), options);
  auto b = observe(other, model_of_slope(), options);
  for (BlockRuns& runs : b) runs.screens.erase(runs.screens.begin());
  expect_same(a[1], b[4]);
  expect_same(a[6], b[0]);
}

TEST(Observe, LaterTrialsAreThoseOfALongerRun) {
  const Campaign c = campaign_on_slope(2);
  ObserveOptions all, last;
  all.trials = 50;
  last.trials = 10;
  last.first_trial = 40;
  const auto a = observe(c, model_of_slope(), all), b = observe(c, model_of_slope(), last);
  EXPECT_EQ(std::vector<double>(a[1].x.begin() + 40, a[1].x.end()), b[1].x);
}

/// A trial that needs more vertices than a search allows has no stop and is counted; all others are the same.
TEST(Observe, CountsWhatASearchCutsShort) {
  Campaign c = campaign_on_slope(3);
  const Model model = model_of_slope();
  const auto whole = observe(c, model, {60, 1, 0, 0, {}, {}});
  const Cover cover{model.grounds, {}};
  const World world{c.surface, cover, model.impact, EndRules{}};
  constexpr std::uint32_t kMost = 70;
  const auto bounded = observe(c, model, {60, 1, 0, 0, {}, {}, {kMost, 0.2}});
  std::uint32_t all = 0;
  for (std::uint32_t b = 0; b < 3; ++b) {
    std::uint32_t cut_short = 0;
    for (std::uint32_t t = 0; t < 60; ++t) {
      Path path;
      trace(world, release_of(c, b, 1, t), path);
      const bool cut = bounded[b].end[t] == End::Limit;
      cut_short += cut ? 1 : 0;
      if (cut) {
        EXPECT_GT(path.vertices.size(), kMost);
        EXPECT_TRUE(std::isnan(bounded[b].x[t]));
      } else if (!std::isnan(whole[b].x[t])) {
        EXPECT_EQ(bounded[b].x[t], whole[b].x[t]);
        EXPECT_LT(path.vertices.size(), kMost + 1010) << "one more impact and slide, which has at most 1000 pieces";
      }
    }
    EXPECT_EQ(bounded[b].cut_short, cut_short);
    EXPECT_EQ(whole[b].cut_short, 0U);
    all += cut_short;
  }
  EXPECT_GT(all, 20U);
  EXPECT_LT(all, 160U);
}

/// Without measurement errors the observations of a path are the engine's values.
TEST(Observe, WithoutErrorsItIsThePath) {
  Campaign c = campaign_on_slope(3);
  c.error = {};
  c.blocks[1].samples = {{0, 0, 0, 15.0, 1.0, 1.0}, {0, 0, 0, 60.0, 1.0, 1.0}, {0, 0, 0, 5000.0, 1.0, 1.0}};
  const Model model = model_of_slope();
  ObserveOptions options;
  options.trials = 20;
  const auto runs = observe(c, model, options);
  const Cover cover{model.grounds, {}};
  const World world{c.surface, cover, model.impact, EndRules{}};
  const ScreenFinder finder(c.surface, c.screens);
  std::uint64_t ends = 0;
  for (std::uint32_t t = 0; t < 20; ++t) {
    const Release release = release_of(c, 1, 1, t);
    Path path;
    trace(world, release, path);
    const Vec3& end = path.vertices.back().motion.position;
    if (rests(path.end))
      EXPECT_EQ(runs[1].x[t], end.x());
    else
      EXPECT_TRUE(std::isnan(runs[1].x[t]));
    std::vector<Crossing> crossings;
    finder.find(release, path, crossings);
    if (crossings.empty()) {
      EXPECT_TRUE(std::isnan(runs[1].screens[0].speed[t]));
    } else {
      EXPECT_EQ(runs[1].screens[0].speed[t], crossings[0].speed);
      EXPECT_EQ(runs[1].screens[0].jump[t], crossings[0].height);
      EXPECT_EQ(runs[1].screens[0].spin[t], crossings[0].spin);
    }
    EXPECT_EQ(runs[1].impacts[t], path.impacts);
    EXPECT_TRUE(std::isnan(runs[1].samples[2].speed[t]));  // nothing gets so far
    // Kinetic and potential energy between two vertices of a flight are conserved: the speed at a sample of a flight is
    // that of its first vertex, less what the height took.
    const double farthest = (end.head<2>() - Eigen::Vector2d(c.blocks[1].x, c.blocks[1].y)).norm();
    if (farthest > 60.0) {
      EXPECT_GT(runs[1].samples[1].speed[t], 0.0);
    }
    ends += 1;
  }
  EXPECT_EQ(std::accumulate(runs[1].ends.begin(), runs[1].ends.end(), std::uint64_t{0}), ends);
}

/// A barrier of a model is one of a run: above its capacity it takes just that, and the block goes on with the rest.
TEST(Observe, ABarrierThatBreaksTakesItsCapacity) {
  Campaign c = campaign_on_slope(4);
  c.error = {};
  Model model = model_of_slope();
  const auto free = observe(c, model, {50, 1, 0, 0, {}, {}});
  constexpr double kCapacity = 2000.0;  // [J]
  model.barriers.push_back({"weak", {{{89.999, 0.0}, {89.999, 140.0}}}, 1e6, kCapacity});
  const auto braked = observe(c, model, {50, 1, 0, 0, {}, {}});
  int passed = 0;
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    for (std::size_t t = 0; t < 50; ++t) {
      const double before = free[b].screens[0].speed[t], after = braked[b].screens[0].speed[t];
      if (std::isnan(before)) continue;
      const double left = before * before - 2.0 * kCapacity / c.blocks[b].mass;  // of v^2, a millimetre farther down
      if (left > 1.0) {
        EXPECT_NEAR(after * after, left, 0.1) << b << ' ' << t;
        ++passed;
      } else if (left < -1.0) {
        EXPECT_EQ(braked[b].end[t], End::Caught);
      }
    }
  EXPECT_GT(passed, 20);
}

/// A free fall over an edge: at a distance r the speed follows from the energy.
TEST(Observe, SampleOfAParabola) {
  Campaign c;
  c.surface = Surface(terrain(grid_of(60, 20, 2.0, 2.0), [](double x, double) { return x < 10.0 ? 100.0 : 0.0; }));
  c.zone_names = {"default"};
  MeasuredBlock b;
  b.x = 12.5;
  b.y = 20.0;
  b.release_height = 80.0;
  b.velocity = Vec3(6.0, 8.0, 0.0);
  b.samples = {{0, 0, 0, 0.0, 1.0, 1.0}, {0, 0, 0, 10.0, 1.0, 1.0}};
  c.blocks = {b};
  ObserveOptions options;
  options.trials = 1;
  const auto runs = observe(c, model_of_slope(), options);
  EXPECT_EQ(runs[0].samples[0].speed[0], 10.0);
  EXPECT_NEAR(runs[0].samples[1].speed[0], std::hypot(10.0, kGravity * 1.0),
              1e-12 * 20.0);  // 10 m at 10 m/s: after 1 s
}

/// A slide from rest down 45 degrees: at the distance r in plan v^2 = 2 g (1 - tan(phi)) r.
TEST(Observe, SampleOfASlide) {
  Campaign c;
  c.surface = Surface(terrain(grid_of(40, 9, 5.0, 5.0), [](double x, double) { return 500.0 - x; }));
  c.zone_names = {"default"};
  MeasuredBlock b;
  b.x = b.y = 22.5;
  b.release_height = 0.0;
  b.mass = block_of(4.0, b.density).mass;
  b.samples = {{0, 0, 0, 0.02, 1.0, 1.0}, {0, 0, 0, 0.5, 1.0, 1.0}};
  c.blocks = {b};
  Model model;
  model.grounds = {Ground{}};  // smooth, phi = 30 degrees
  ObserveOptions options;
  options.trials = 1;
  const auto runs = observe(c, model, options);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(runs[0].samples[i].speed[0],
                std::sqrt(2.0 * 9.81 * (1.0 - 1.0 / std::sqrt(3.0)) * b.samples[i].distance), 1e-6);
}

/// Mean and spread of the place of release in a disc of radius R: 0, and R/2 in each direction.
TEST(Observe, ReleasesFillTheirDisc) {
  Campaign c = campaign_on_slope(1);
  c.blocks[0].x = 30.0;
  c.blocks[0].release_radius = 4.0;
  Moments x, y;
  double farthest = 0.0;
  constexpr std::uint32_t kDraws = 20000;
  for (std::uint32_t t = 0; t < kDraws; ++t) {
    const Vec3 p = release_of(c, 0, 1, t).motion.position;
    x.add(p.x() - 30.0);
    y.add(p.y() - c.blocks[0].y);
    farthest = std::max(farthest, std::hypot(p.x() - 30.0, p.y() - c.blocks[0].y));
    ASSERT_NEAR(p.z() - *c.surface.height(p.x(), p.y()), c.blocks[0].release_height, 1e-9);
  }
  EXPECT_NEAR(x.mean(), 0.0, 5.0 * 2.0 / std::sqrt(kDraws));
  EXPECT_NEAR(y.mean(), 0.0, 5.0 * 2.0 / std::sqrt(kDraws));
  EXPECT_NEAR(x.squares / x.count, 4.0, 5.0 * 3.3 / std::sqrt(kDraws));
  EXPECT_LE(farthest, 4.0);
  EXPECT_GT(farthest, 3.99);
}

/// The errors have the spread that the campaign says, and do not depend on the model.
TEST(Observe, MeasurementErrors) {
  Campaign exact = campaign_on_slope(3), noisy = exact;
  exact.error = {};
  ObserveOptions options;
  options.trials = 1000;
  Model soft = model_of_slope();
  soft.grounds[0].En50 = 1.0;
  const auto a = observe(exact, model_of_slope(), options), b = observe(noisy, model_of_slope(), options);
  const auto c = observe(exact, soft, options), d = observe(noisy, soft, options);
  Moments place, speed;
  for (std::size_t t = 0; t < 1000; ++t) {
    if (!std::isnan(a[0].x[t])) place.add((b[0].x[t] - a[0].x[t]) / 0.3);
    if (!std::isnan(a[0].x[t]) && !std::isnan(c[0].x[t]))
      EXPECT_NEAR(b[0].x[t] - a[0].x[t], d[0].x[t] - c[0].x[t], 1e-9);
    const double v = a[0].screens[0].speed[t];
    if (!std::isnan(v)) speed.add((b[0].screens[0].speed[t] / v - 1.0) / 0.03);
    if (!std::isnan(v)) {
      EXPECT_GE(b[0].screens[0].jump[t], 0.0);
    }
  }
  ASSERT_GT(place.count, 500);
  ASSERT_GT(speed.count, 500);
  for (const Moments& m : {place, speed}) {
    EXPECT_NEAR(m.mean(), 0.0, 5.0 / std::sqrt(m.count));
    EXPECT_NEAR(m.squares / m.count, 1.0, 5.0 * std::sqrt(2.0 / m.count));
  }
}

}  // namespace
}  // namespace talus::test
