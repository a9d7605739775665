#include "fit/diagnose/rocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

MeasuredBlock block_of(double mass, const Vec3& axes, const std::string& rock = {}) {
  MeasuredBlock b;
  b.mass = mass;
  b.axes = axes;
  b.rock = rock;
  return b;
}

std::vector<std::size_t> rocks_in(const std::vector<MeasuredBlock>& blocks) {
  Campaign campaign;
  campaign.blocks = blocks;
  std::vector<std::size_t> all(blocks.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return rocks_of(campaign, all);
}

using Rocks = std::vector<std::size_t>;

/// The three rocks of Tschamut, each weighed and measured again 17 times with errors of 0.3 %.
TEST(Rocks, WeighedAgainAreTheSameInAnyOrder) {
  const std::vector<MeasuredBlock> three{block_of(69.0, {0.37, 0.37, 0.32}), block_of(79.0, {0.50, 0.39, 0.30}),
                                         block_of(40.0, {0.46, 0.30, 0.20})};
  Numbers numbers(41);
  std::vector<MeasuredBlock> blocks;
  Rocks made;
  for (std::size_t i = 0; i < 51; ++i) {
    MeasuredBlock b = three[i % 3];
    b.mass *= 1.0 + 0.003 * numbers.normal();
    for (double& axis : b.axes) axis *= 1.0 + 0.003 * numbers.normal();
    blocks.push_back(b);
    made.push_back(i % 3);
  }
  EXPECT_EQ(rocks_in(blocks), made);
  std::rotate(blocks.begin(), blocks.begin() + 20, blocks.end());
  std::ranges::reverse(blocks);
  for (std::size_t i = 0; i < made.size(); ++i) made[i] = i % 3;  // every third, in whatever order
  EXPECT_EQ(rocks_in(blocks), made);
}

/// A block 1.9 % heavier or longer (ln 1.019 = 0.0188) is the same rock, one 2.1 % larger (0.0208) is another rock.
TEST(Rocks, AreEqualToTwoPercentInMassAndAllAxes) {
  const MeasuredBlock one = block_of(1000.0, {1.0, 0.8, 0.6});
  EXPECT_EQ(rocks_in({one, block_of(1019.0, {1.019, 0.8, 0.6 / 1.019})}), (Rocks{0, 0}));
  EXPECT_EQ(rocks_in({one, block_of(1021.0, {1.0, 0.8, 0.6})}), (Rocks{0, 1}));
  for (int axis = 0; axis < 3; ++axis) {
    MeasuredBlock other = one;
    other.axes[axis] *= 1.021;
    EXPECT_EQ(rocks_in({one, other}), (Rocks{0, 1})) << axis;
  }
  EXPECT_TRUE(rocks_in({}).empty());
}

/// Spheres whose masses rise in steps: three steps of 1.9 % are one rock of 5.7 %; a chain of 40 blocks is no rock.
TEST(Rocks, OfAChainAreNotOne) {
  std::vector<MeasuredBlock> few, many;
  for (int i = 0; i < 4; ++i) few.push_back(block_of(100.0 * std::exp(0.019 * i), Vec3::Ones()));
  for (int i = 0; i < 40; ++i) many.push_back(block_of(100.0 * std::exp(0.012 * i), Vec3::Ones()));
  EXPECT_EQ(rocks_in(few), (Rocks{0, 0, 0, 0}));
  Rocks each(40);
  std::iota(each.begin(), each.end(), std::size_t{0});
  EXPECT_EQ(rocks_in(many), each);
  many.insert(many.end(), 2, many[7]);
  each.insert(each.end(), 2, 7);
  EXPECT_EQ(rocks_in(many), each) << "of an equal mass: one rock within a chain, too";
}

TEST(Rocks, ANameSaysMoreThanTheSize) {
  const Vec3 a(1.0, 0.8, 0.6), b(1.1, 0.8, 0.6);
  EXPECT_EQ(rocks_in({block_of(900.0, a, "K"), block_of(900.0, a, "M"), block_of(700.0, b, "K"), block_of(900.0, a),
                      block_of(905.0, a)}),
            (Rocks{0, 1, 0, 2, 2}));
}

}  // namespace
}  // namespace talus::test
