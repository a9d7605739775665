#include "talus/terrain/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

constexpr double kQuantum = 0x1p-16;  // of the floats of kSlope, whose relief is 289 m: 2^8 m, 24 bits

const Profile kSlope{{{10.0, 400.0}, {222.0, 234.3674}, {227.0, 234.3674}, {370.0, 137.9}, {570.3, 111.11}}};

TEST(Profile, HeightIsStraightBetweenNodes) {
  const Profile p{{{0.0, 10.0}, {4.0, 2.0}, {5.0, 2.0}}};
  for (const auto& [x, z] :
       {std::pair{0.0, 10.0}, {1.0, 8.0}, {4.0, 2.0}, {4.5, 2.0}, {5.0, 2.0}, {-1.0, 10.0}, {9.0, 2.0}})
    EXPECT_DOUBLE_EQ(p.height(x), z) << x;
}

TEST(Extrude, MeetsTheNodesWithinTheBoundItStates) {
  const ExtrudedProfile e = extrude(kSlope, 0.1);
  const Grid& grid = e.heights.grid;
  EXPECT_EQ(grid.columns, 5604);
  EXPECT_EQ(grid.rows, 2);
  for (const Eigen::Vector2d& node : kSlope.nodes) {
    const int column = static_cast<int>(std::lround((node.x() - 10.0) / 0.1));
    EXPECT_NEAR(grid.west + grid.centre_x(column), node.x(), 1e-9);
    EXPECT_NEAR(e.datum + static_cast<double>(e.heights.at(column, 0)), node.y(), 0.501 * kQuantum) << node.x();
  }
  for (int column = 0; column < grid.columns; ++column) {  // between the nodes: 2120 columns, a quarter quantum each
    const double below = kSlope.height(10.0 + 0.1 * column) - e.datum - static_cast<double>(e.heights.at(column, 0));
    ASSERT_GE(below, -0.501 * kQuantum) << column;
    ASSERT_LE(below, (0.25 * 2120 + 0.501) * kQuantum) << column;
  }
}

TEST(Extrude, ALongSlopeDoesNotTiltTheRoadBelowIt) {  // the rise of 0.05 m is no whole number of 2^-15 m
  const Profile slope{{{0.0, 1500.28}, {1000.0, 900.0}, {1005.0, 900.0}, {1500.0, 600.0}}};
  const ExtrudedProfile e = extrude(slope, 0.05);
  for (const auto& [column, z] : {std::pair{0, 1500.28}, {20000, 900.0}, {20100, 900.0}, {30000, 600.0}})
    EXPECT_NEAR(e.datum + static_cast<double>(e.heights.at(column, 0)), z, 1e-4) << column;
  for (int c = 20000; c < 20100; ++c) ASSERT_EQ(e.heights.at(c + 1, 0), e.heights.at(c, 0)) << c;
}

/// How much more each column after the first rises than the one before it [m]; not 0 at an edge between two planes.
std::vector<double> turns(const ExtrudedProfile& e) {
  std::vector<double> turns{0.0};
  const auto z = [&](int c) { return static_cast<double>(e.heights.at(c, 0)); };
  for (int c = 1; c + 1 < e.heights.grid.columns; ++c) turns.push_back((z(c + 1) - z(c)) - (z(c) - z(c - 1)));
  return turns;
}

TEST(Extrude, ASegmentIsOneConcaveEdgeAtMost) {  // at a convex one a block that slides would take off
  const ExtrudedProfile e = extrude(kSlope, 0.1);
  const std::vector<double> all = turns(e);
  const std::vector<int> nodes{0, 2120, 2170, 3600, 5603};
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    std::vector<double> edges;
    for (int c = nodes[i - 1] + 1; c < nodes[i]; ++c)
      if (all[static_cast<std::size_t>(c)] != 0.0) edges.push_back(all[static_cast<std::size_t>(c)]);
    EXPECT_LE(edges.size(), i == 2 ? 0U : 1U) << "segment " << i;  // the second is level
    for (const double edge : edges) EXPECT_EQ(edge, kQuantum) << "segment " << i;
  }
  for (int c = 0; c < e.heights.grid.columns; ++c) ASSERT_EQ(e.heights.at(c, 0), e.heights.at(c, 1));
}

TEST(Extrude, ASegmentWithAWholeRiseIsOnePlaneToTheLastBit) {  // 0.375 m and 0.25 m in a step of 0.5 m
  const std::vector<double> all = turns(extrude({{{0.0, 200.0}, {150.0, 87.5}, {300.0, 12.5}}}, 0.5));
  for (std::size_t c = 0; c < all.size(); ++c) ASSERT_EQ(all[c], c == 300 ? 0.125 : 0.0) << c;
}

TEST(Extrude, AMirroredProfileGivesMirroredHeights) {
  Profile mirrored;
  for (auto node = kSlope.nodes.rbegin(); node != kSlope.nodes.rend(); ++node)
    mirrored.nodes.emplace_back(580.3 - node->x(), node->y());
  const ExtrudedProfile a = extrude(kSlope, 0.1), b = extrude(mirrored, 0.1);
  ASSERT_EQ(a.heights.grid.columns, b.heights.grid.columns);
  for (int c = 0; c < a.heights.grid.columns; ++c)
    ASSERT_EQ(a.heights.at(c, 0), b.heights.at(a.heights.grid.columns - 1 - c, 0)) << c;
}

TEST(Extrude, AWallOfOneStep) {
  const ExtrudedProfile e = extrude({{{0.0, 50.0}, {1.0, 50.0}, {1.5, 0.0}, {3.0, 0.0}}}, 0.5);
  for (const auto& [column, z] : {std::pair{0, 50.0}, {2, 50.0}, {3, 0.0}, {6, 0.0}})
    EXPECT_NEAR(e.datum + static_cast<double>(e.heights.at(column, 1)), z, 1e-5) << column;
}

}  // namespace
}  // namespace talus
