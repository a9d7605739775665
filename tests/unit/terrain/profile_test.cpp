#include "talus/terrain/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

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
    EXPECT_NEAR(e.datum + static_cast<double>(e.heights.at(column, 0)), node.y(), 0.017) << node.x();  // 2120 * 2^-17
  }
}

TEST(Extrude, ASegmentIsOnePlaneToTheLastBit) {  // else a block that slides would meet creases that are not there
  const ExtrudedProfile e = extrude(kSlope, 0.1);
  const auto rise = [&](int c) {
    return static_cast<double>(e.heights.at(c + 1, 0)) - static_cast<double>(e.heights.at(c, 0));
  };
  int creases = 0;
  for (int c = 1; c + 1 < e.heights.grid.columns; ++c) creases += rise(c) != rise(c - 1) ? 1 : 0;
  EXPECT_EQ(creases, 3);
  for (int c = 0; c < e.heights.grid.columns; ++c) ASSERT_EQ(e.heights.at(c, 0), e.heights.at(c, 1));
}

TEST(Extrude, AMirroredProfileGivesMirroredHeights) {
  Profile mirrored;
  for (auto node = kSlope.nodes.rbegin(); node != kSlope.nodes.rend(); ++node)
    mirrored.nodes.emplace_back(580.3 - node->x(), node->y());
  const ExtrudedProfile a = extrude(kSlope, 0.1), b = extrude(mirrored, 0.1);
  ASSERT_EQ(a.heights.grid.columns, b.heights.grid.columns);
  for (int c = 0; c < a.heights.grid.columns; ++c)  // each within its bound of the nodes
    ASSERT_NEAR(a.heights.at(c, 0), b.heights.at(a.heights.grid.columns - 1 - c, 0), 0.034) << c;
}

TEST(Extrude, AWallOfOneStep) {
  const ExtrudedProfile e = extrude({{{0.0, 50.0}, {1.0, 50.0}, {1.5, 0.0}, {3.0, 0.0}}}, 0.5);
  for (const auto& [column, z] : {std::pair{0, 50.0}, {2, 50.0}, {3, 0.0}, {6, 0.0}})
    EXPECT_NEAR(e.datum + static_cast<double>(e.heights.at(column, 1)), z, 1e-5) << column;
}

}  // namespace
}  // namespace talus
