#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "support/scenes.hpp"
#include "talus/base/random.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/trace.hpp"
#include "talus/physics/tracer.hpp"
#ifdef TALUS_HAS_LANES
#include "lanes/formulas.hpp"
#endif

namespace talus {
namespace {

using test::Numbers;

/// Whether all bits are equal; padding between members is not looked at.
template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(T)) == 0;
}
bool same(const Vertex& a, const Vertex& b) {
  return same_bits(a.motion, b.motion) && a.event == b.event;
}
template <class Buffers>
bool all_same(const Buffers& a, const Buffers& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if constexpr (requires { same(a[i], b[i]); }) {
      if (!same(a[i], b[i])) return false;
    } else if (!same_bits(a[i], b[i])) {
      return false;
    }
  return true;
}
void expect_same(const Path& a, const Path& b) {
  EXPECT_TRUE(all_same(a.vertices, b.vertices));
  EXPECT_TRUE(all_same(a.spans, b.spans));
  EXPECT_TRUE(all_same(a.spins, b.spins));
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.impacts, b.impacts);
  EXPECT_EQ(a.psi_dropped, b.psi_dropped);
  EXPECT_TRUE(same_bits(a.length, b.length) && same_bits(a.plan_length, b.plan_length) && same_bits(a.mass, b.mass));
}

/// Rough ground that falls towards the south, with cells of 2 x 3 m: one of many variants.
struct VariedScene {
  Surface surface;
  Cover cover;
  World world;
  std::vector<Release> releases;

  explicit VariedScene(unsigned variant)
      : surface(heights(variant), variant % 2 == 1 ? SurfaceKind::Creased : SurfaceKind::Bilinear),
        cover(grounds(variant)),
        world{surface, cover, {}, {}} {
    world.impact.roughness = variant % 5 == 1 ? Roughness::Resample : Roughness::Clamp;
    world.impact.in_plane = variant % 6 == 5;
    if (variant % 7 == 6) world.rules.impact_limit = 20;
    if (variant % 7 == 5) world.rules.time_limit = 3.0;
    if (variant % 7 == 4) world.effort.most_vertices = 30;
    Numbers numbers(variant);
    for (std::uint32_t block = 0; block < 150; ++block) releases.push_back(release(numbers, variant, block));
  }

  Raster<float> heights(unsigned variant) {
    Numbers numbers(100 + variant);
    Raster<float> made(Grid{60, 50, 2.0, 3.0}, 0.0F);
    for (int row = 0; row < 50; ++row)
      for (int column = 0; column < 60; ++column)
        made.at(column, row) = static_cast<float>(3.0 * row * numbers.uniform(0.5, 0.8) +
                                                  numbers.uniform(0.0, 1.0 + variant % 5));  // with pits
    for (int hole = 0; variant % 3 == 0 && hole < 12; ++hole)
      made.at(static_cast<int>(numbers.uniform(0, 60)), static_cast<int>(numbers.uniform(0, 40))) = std::nanf("");
    return made;
  }

  Cover grounds(unsigned variant) const {
    Cover made{{{1.0, 0.9, 15, 50, 0.577, 1, 1.5}, {0.4, 0.3, 20, 40, 0.7, 1, 1.2}, {0, 0, 5, 50, 0.3, 1, 1}}, {}};
    if (variant % 4 < 2) return made;
    made.zones = Raster<std::uint8_t>(surface.grid(), std::uint8_t{0});
    Numbers numbers(200 + variant);
    for (std::uint8_t& zone : made.zones.values) zone = static_cast<std::uint8_t>(numbers.uniform(0.0, 2.99));
    return made;
  }

  Release release(Numbers& numbers, unsigned variant, std::uint32_t block) const {
    Release made;
    made.seed = (std::uint64_t{1} << 40U) + variant;  // both words of the key
    made.source = variant;
    made.block = block;
    made.body = block_of(numbers.uniform(0.3, block % 4 == 0 ? 12.0 : 2.0), 2500.0);
    const double x = numbers.uniform(2.0, 118.0), y = numbers.uniform(2.0, 145.0);
    made.motion.position = {x, y, surface.height(x, y).value_or(std::nan("")) + numbers.uniform(0.0, 5.0)};
    if (block % 3 != 0)  // the others fall
      made.motion.velocity = {numbers.uniform(-5, 5), numbers.uniform(-5, 5), numbers.uniform(-1, 3)};
    return made;
  }
};

class InLanes : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > most_lanes()) GTEST_SKIP() << "this processor has no " << GetParam() << " lanes";
  }
};
INSTANTIATE_TEST_SUITE_P(Lanes, InLanes, testing::Values(1, 4, 8));

/// Traces the releases in lanes and compares each path with that of `trace`. Returns the number of each end.
std::array<int, kEnds> compare(const World& world, const std::vector<Release>& releases, int lanes) {
  std::array<int, kEnds> ends{};
  std::size_t released = 0, done = 0;
  Path alone;
  Tracer tracer(world, lanes);
  tracer.run(
      [&](Release& release, std::uint64_t& tag) {
        if (released == releases.size()) return false;
        tag = released;
        release = releases[released++];
        return true;
      },
      [&](const Release& release, const Path& path, std::uint64_t tag) {
        EXPECT_EQ(tag, done++) << "paths come in the order of the releases";
        EXPECT_EQ(release.block, releases[tag].block);
        trace(world, releases[tag], alone);
        expect_same(path, alone);
        ++ends[static_cast<std::size_t>(path.end)];
      });
  EXPECT_EQ(done, releases.size());
  return ends;
}

TEST_P(InLanes, PathsHaveTheBitsOfOneLane) {  // holes, creases, edges, pits, grounds, roughness, plane, limits
  std::array<int, kEnds> ends{};
  for (unsigned variant = 0; variant < 42; ++variant) {
    SCOPED_TRACE(variant);
    const VariedScene scene(variant);
    const auto more = compare(scene.world, scene.releases, GetParam());
    for (std::size_t end = 0; end < ends.size(); ++end) ends[end] += more[end];
    if (HasFailure()) break;
  }
  for (const End end : {End::Stopped, End::Trapped, End::Left, End::Limit})
    EXPECT_GT(ends[static_cast<std::size_t>(end)], 100);
}

TEST_P(InLanes, LongPathsAreTracedOneByOne) {  // 20 000 patches down a smooth slope, among short ones
  Raster<float> heights(Grid{6, 20'100, 1.0, 1.0}, 0.0F);
  for (int row = 0; row < 20'100; ++row)
    for (int column = 0; column < 6; ++column) heights.at(column, row) = static_cast<float>(row);
  const Surface surface(std::move(heights));
  const Cover cover{{{0.0, 0.0, 15, 50, 0.577, 1.0, 1.0}}, {}};
  World world{surface, cover, {}, {}};
  std::vector<Release> releases(40);
  for (std::uint32_t block = 0; block < 40; ++block) {
    releases[block].block = block;
    releases[block].motion.position = {3.2, block % 5 == 2 ? 20'000.3 : 100.3, 0.0};
    releases[block].motion.position.z() = *surface.height(3.2, releases[block].motion.position.y()) + 1.0;
    releases[block].motion.velocity = {0.0, -1.0, 0.0};
  }
  Path path;
  trace(world, releases[2], path);
  ASSERT_GT(path.spans.size(), 19'000U);
  compare(world, releases, GetParam());
}

TEST_P(InLanes, ManyBlocksThatSlideTurnAfterTurn) {  // on smooth steep ground no flight comes between
  Raster<float> heights(Grid{60, 400, 2.0, 2.0}, 0.0F);
  for (int row = 0; row < 400; ++row)
    for (int column = 0; column < 60; ++column) heights.at(column, row) = 1.6F * static_cast<float>(row);
  const Surface surface(std::move(heights));
  for (const double roughness : {0.0, 0.1, 1.0}) {
    SCOPED_TRACE(roughness);
    const Cover cover{{{roughness, roughness, 15, 50, 0.577, 1.0, 1.5}}, {}};
    const World world{surface, cover, {}, {}};
    Numbers numbers(7);
    std::vector<Release> releases(300);
    for (std::uint32_t block = 0; block < releases.size(); ++block) {
      Release& release = releases[block];
      release.block = block;
      release.body = block_of(numbers.uniform(0.3, block % 4 == 0 ? 12.0 : 2.0), 2500.0);
      const double x = numbers.uniform(5.0, 115.0), y = numbers.uniform(600.0, 790.0);
      release.motion.position = {x, y, *surface.height(x, y) + 0.5 * (block % 3)};
    }
    compare(world, releases, GetParam());
  }
}

TEST_P(InLanes, BlocksThatFallDownAWall) {  // within their diameter in plan: the height of the anchor counts
  Raster<float> heights(Grid{60, 120, 1.0, 1.0}, 0.0F);
  for (int row = 0; row < 120; ++row)
    for (int column = 0; column < 60; ++column)
      heights.at(column, row) = 0.65F * static_cast<float>(row) + (row < 60 ? 0.0F : 100.0F);
  const Surface surface(std::move(heights));
  const Cover cover{{{1.0, 0.9, 15, 50, 0.577, 1.0, 1.5}}, {}};
  const World world{surface, cover, {}, {}};
  std::vector<Release> releases(1000);
  for (std::uint32_t block = 0; block < releases.size(); ++block) {
    const double y = 60.5 + 0.02 * (block % 100);
    releases[block].block = block;
    releases[block].body = block_of(4.0, 2700.0);
    releases[block].motion.position = {30.0, y, *surface.height(30.0, y) + 0.5};
  }
  compare(world, releases, GetParam());
}

TEST_P(InLanes, NothingToTrace) {
  const VariedScene scene(1);
  compare(scene.world, {}, GetParam());
  compare(scene.world, {scene.releases.front()}, GetParam());
}

TEST_P(InLanes, AnExceptionReachesTheCallerAndTheNextRunIsWhole) {
  const VariedScene scene(3);
  Tracer tracer(scene.world, GetParam());
  std::size_t released = 0;
  const NextRelease next = [&](Release& release, std::uint64_t&) {
    if (released == scene.releases.size()) return false;
    release = scene.releases[released++];
    return true;
  };
  const PathDone fail = [](const Release& release, const Path&, std::uint64_t) {
    if (release.block == 17) throw std::runtime_error("disk full");
  };
  EXPECT_THROW(tracer.run(next, fail), std::runtime_error);
  released = 0;
  std::uint32_t done = 0;
  Path alone;
  tracer.run(next, [&](const Release& release, const Path& path, std::uint64_t) {
    EXPECT_EQ(release.block, done++);
    trace(scene.world, release, alone);
    expect_same(path, alone);
  });
  EXPECT_EQ(done, scene.releases.size());
}

TEST(Lanes, OneInAWorldWithBarriers) {
  const VariedScene scene(0);
  const Barriers barriers({{"net", {{{0.0, 50.0}, {120.0, 50.0}}}, 100.0, std::numeric_limits<double>::infinity()}});
  World world = scene.world;
  EXPECT_EQ(lanes_in(world, 0), most_lanes());
  EXPECT_EQ(lanes_in(world, 1), 1);
  world.barriers = &barriers;
  EXPECT_EQ(lanes_in(world, 0), 1);
  EXPECT_GT(compare(world, scene.releases, 0)[static_cast<std::size_t>(End::Caught)], 0);
}

#ifdef TALUS_HAS_LANES
class FormulasInLanes : public InLanes {
 protected:
  static constexpr int kCount = 8000;
  test::Formulas formulas() const {
    return GetParam() == 8 ? test::formulas_in_8_lanes() : test::formulas_in_4_lanes();
  }
  std::vector<double> numbers(int seed, double low, double high, int count = kCount) const {
    Numbers random(seed);
    std::vector<double> made(static_cast<std::size_t>(count));
    for (double& x : made) x = random.uniform(low, high);
    return made;
  }
};
INSTANTIATE_TEST_SUITE_P(Lanes, FormulasInLanes, testing::Values(4, 8));

TEST_P(FormulasInLanes, Logarithm) {
  std::vector<double> x = numbers(1, 0.0, 1.0), result(kCount);
  for (int i = 0; i < kCount; ++i) {
    if (i % 2 == 1) x[i] = std::ldexp(x[i] + 0.5, i % 1900 - 950);
    if (i % 16 == 0) x[i] = uniform(static_cast<std::uint32_t>(i / 16));  // near 0
    if (i % 16 == 8) x[i] = std::nextafter(std::sqrt(0.5), i % 32 == 8 ? 0.0 : 1.0);
  }
  formulas().natural_log(x.data(), result.data(), kCount);
  for (int i = 0; i < kCount; ++i) EXPECT_TRUE(same_bits(result[i], natural_log(x[i]))) << x[i];
}

TEST_P(FormulasInLanes, SineAndCosine) {
  std::vector<double> turn = numbers(2, 0.0, 1.0), sine(kCount), cosine(kCount);
  for (int eighth = 0; eighth <= 8; ++eighth)
    for (int side = 0; side < 3; ++side)
      turn[3 * eighth + side] = std::clamp(std::nextafter(eighth / 8.0, side == 0   ? -1.0
                                                                        : side == 1 ? 2.0
                                                                                    : eighth / 8.0),
                                           0.0, 1.0);
  formulas().sine_cosine(turn.data(), sine.data(), cosine.data(), kCount);
  for (int i = 0; i < kCount; ++i) {
    const SineCosine one = sine_cosine_of_turn(turn[i]);
    EXPECT_TRUE(same_bits(sine[i], one.sine) && same_bits(cosine[i], one.cosine)) << turn[i];
  }
}

TEST_P(FormulasInLanes, RandomWords) {
  std::vector<std::uint64_t> words(4 * kCount), key(2 * kCount);
  Numbers random(3);
  for (auto* numbers : {&words, &key})
    for (std::uint64_t& word : *numbers) word = static_cast<std::uint32_t>(random.uniform(0.0, 4294967295.9));
  for (int word = 0; word < 4; ++word) words[word * kCount] = 0xFFFFFFFF;  // the known answer of Random123
  key[0] = key[kCount] = 0xFFFFFFFF;
  const std::vector<std::uint64_t> before = words;
  formulas().philox(words.data(), key.data(), kCount);
  EXPECT_EQ(words[0], 0x408f276dU);
  for (int i = 0; i < kCount; ++i) {
    const auto of = [&](const std::vector<std::uint64_t>& from, int word) {
      return static_cast<std::uint32_t>(from[word * kCount + i]);
    };
    const Words one =
        philox4x32({of(before, 0), of(before, 1), of(before, 2), of(before, 3)}, {of(key, 0), of(key, 1)});
    for (int word = 0; word < 4; ++word) ASSERT_EQ(words[word * kCount + i], one[word]) << i;
  }
}

TEST_P(FormulasInLanes, FirstContact) {
  std::vector<double> f0 = numbers(4, 0.0, 3.0), f1 = numbers(5, -5.0, 5.0), f2 = numbers(6, -5.0, 2.0),
                      until = numbers(7, 0.0, 2.0), result(kCount);
  const double special[] = {0.0, -0.0, std::numeric_limits<double>::infinity(), std::nan(""), 1.0, -1.0};
  for (int i = 0; i < kCount / 4; ++i) {
    f0[i] = i % 3 == 0 ? special[i % 6] : f0[i];
    f1[i] = i % 2 == 0 ? special[i / 6 % 6] : f1[i];
    f2[i] = i % 5 == 0 ? special[i / 36 % 6] : f2[i];
    until[i] = i % 4 == 0 ? special[i / 216 % 6] : until[i];
  }
  formulas().first_contact(f0.data(), f1.data(), f2.data(), until.data(), result.data(), kCount);
  for (int i = 0; i < kCount; ++i) {
    const double one = first_contact(f0[i], f1[i], f2[i], until[i]);
    EXPECT_TRUE(same_bits(result[i], one)) << f0[i] << ' ' << f1[i] << ' ' << f2[i] << ' ' << until[i];
  }
}

TEST_P(FormulasInLanes, SumsInTheOrderOfEigen) {
  const std::vector<double> u = numbers(8, -1.0, 1.0, 3 * kCount), v = numbers(9, -1.0, 1.0, 3 * kCount);
  std::vector<double> dot(kCount), cross(3 * kCount);
  formulas().dot_and_cross(u.data(), v.data(), dot.data(), cross.data(), kCount);
  for (int i = 0; i < kCount; ++i) {
    const Vec3 a(u[i], u[kCount + i], u[2 * kCount + i]), b(v[i], v[kCount + i], v[2 * kCount + i]), c = a.cross(b);
    EXPECT_TRUE(same_bits(dot[i], a.dot(b)));
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(cross[k * kCount + i], c[k]));
  }
}
#endif

}  // namespace
}  // namespace talus
