#include "talus/products/barrier_design.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "talus/products/weibull.hpp"

namespace talus {
namespace {

/// 0, 1, ... 100: the percentiles are the numbers.
std::vector<double> hundred(double unit) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(unit * i);
  return values;
}

/// By hand: v95 = 0.2 * 95 = 19, v_d = 19 * 1.02 * 1.10 = 21.318 m/s; m_d = 2 * 2500 * 1.02 = 5100 kg;
/// E_d = 1/2 * 5100 * 21.318^2 = 1 158 866 J; h95 = 0.04 * 95 = 3.8 m, f_min = half of the sphere of 2 m3,
/// (6 * 2 / pi)^(1/3) / 2 = 0.781593 m, h_i = 3.8 * 1.122 + 0.781593 = 5.045193 m.
TEST(DesignBarrier, ByHand) {
  DesignFactors factors;
  factors.trajectory = 1.02;
  factors.topography = 1.10;
  factors.volume = 1.02;
  const BarrierDesign d = design_barrier(hundred(0.2), hundred(0.04), {2.0, 2500.0}, factors);
  EXPECT_NEAR(d.speed_percentile, 19.0, 1e-12);
  EXPECT_NEAR(d.height_percentile, 3.8, 1e-12);
  EXPECT_NEAR(d.speed, 21.318, 1e-12);
  EXPECT_NEAR(d.mass, 5100.0, 1e-9);
  EXPECT_NEAR(d.energy, 1158865.67, 0.01);
  EXPECT_NEAR(d.sel, d.energy, 1e-6);
  EXPECT_NEAR(d.mel, 1.3 * d.energy, 1e-6);
  EXPECT_NEAR(d.freeboard, 0.781593, 1e-6);
  EXPECT_NEAR(d.height, 5.045193, 1e-6);
}

/// The freeboard of small blocks is half a metre: up to a diameter of 1 m, pi / 6 m3.
TEST(DesignBarrier, FreeboardIsHalfAMetreAtLeast) {
  const auto freeboard = [](double volume) {
    return design_barrier(hundred(0.2), hundred(0.0), {volume, 2700.0}, {}).freeboard;
  };
  EXPECT_EQ(freeboard(0.1), 0.5);
  EXPECT_NEAR(freeboard(8.0 * 3.14159265358979 / 6.0), 1.0, 1e-12);
}

TEST(DesignBarrier, AnyPercentile) {
  DesignFactors factors{1.0, 1.0, 1.0, 1.0, 1.0, 1.2, 0.5, 0.975};
  const BarrierDesign d = design_barrier(hundred(0.2), hundred(0.04), {2.0, 2500.0}, factors);
  EXPECT_NEAR(d.speed, 19.5, 1e-12);
  EXPECT_NEAR(d.mel / d.sel, 1.2, 1e-12);
  EXPECT_EQ(fewest_for_percentile(0.95), 20U);
  EXPECT_EQ(fewest_for_percentile(0.5), 2U);
  EXPECT_EQ(fewest_for_percentile(0.99), 100U);
}

/// Energies of the paper's Table 4, given to 10 kJ: MEL / SEL is the factor of the program in three rows, within what
/// rounding allows; the fourth is not of the same factor.
TEST(Table4, RatioOfTheEnergyLevels) {
  const DesignFactors factors;
  const auto agrees = [&](double sel, double mel) {
    return (mel - 5.0) / (sel + 5.0) <= factors.mel / factors.sel &&
           factors.mel / factors.sel <= (mel + 5.0) / (sel - 5.0);
  };
  EXPECT_TRUE(agrees(1070.0, 1390.0));
  EXPECT_TRUE(agrees(1020.0, 1320.0));
  EXPECT_TRUE(agrees(1150.0, 1490.0));
  EXPECT_FALSE(agrees(1320.0, 1610.0));
}

/// Two exceedances of a height fix a Weibull law: k = ln(ln p1 / ln p2) / ln(h1 / h2). Mean and P95 of the laws of
/// Table 4 are those in docs/barrier.md, "Table 4 of the paper".
TEST(Table4, JumpHeightsRecovered) {
  struct Row {
    double h1, p1, h2, p2, shape, scale, mean, p95;
  };
  for (const Row& r :
       {Row{4.02, 0.024, 4.66, 0.011, 1.29, 1.44, 1.34, 3.39}, Row{4.16, 0.062, 4.91, 0.033, 1.23, 1.82, 1.70, 4.42}}) {
    const double shape = std::log(std::log(r.p1) / std::log(r.p2)) / std::log(r.h1 / r.h2);
    const Weibull law{shape, r.h1 / std::pow(-std::log(r.p1), 1.0 / shape)};
    EXPECT_NEAR(law.shape, r.shape, 0.005);
    EXPECT_NEAR(law.scale, r.scale, 0.005);
    EXPECT_NEAR(law.exceedance(r.h2), r.p2, 1e-12);
    EXPECT_NEAR(law.scale * std::tgamma(1.0 + 1.0 / law.shape), r.mean, 0.01);
    EXPECT_NEAR(law.exceedance(r.p95), 0.05, 0.0005);
  }
}

/// 99 of 100 blocks in 10 m, one far off.
TEST(ShortestStretch, LeavesOutTheFarOnes) {
  std::vector<double> places{500.0};
  for (int i = 0; i < 99; ++i) places.push_back(100.0 + i * 10.0 / 98.0);
  const Stretch s = shortest_stretch(places, 0.99);
  EXPECT_NEAR(s.from, 100.0, 1e-12);
  EXPECT_NEAR(s.to, 110.0, 1e-12);
  EXPECT_NEAR(s.share, 0.99, 1e-12);
  for (double& place : places) place = 600.0 - place;  // seen from the other end
  EXPECT_NEAR(shortest_stretch(places, 0.99).from, 490.0, 1e-12);
  EXPECT_NEAR(shortest_stretch(places, 1.0).width(), 400.0, 1e-12);
  EXPECT_EQ(shortest_stretch(places, 1e-9).width(), 0.0);
}

/// Bins of 5 m of 1000 released blocks: 11 in the one from 10 m, 10 in that from 20 m, 12 in that from 30 m. Above
/// 1 %: from 10 m to 35 m.
TEST(StretchAbove, ThePapersRule) {
  std::vector<double> places(11, 12.0);
  places.insert(places.end(), 10, 21.0);
  places.insert(places.end(), 12, 34.9);
  const auto s = stretch_above(places, 5.0, 1000.0, 0.01);
  ASSERT_TRUE(s.has_value());
  EXPECT_EQ(s->from, 10.0);
  EXPECT_EQ(s->to, 35.0);
  EXPECT_EQ(s->share, 1.0);
  EXPECT_EQ(stretch_above(places, 5.0, 1000.0, 0.0115)->from, 30.0);
  EXPECT_FALSE(stretch_above(places, 5.0, 1000.0, 0.012).has_value());
}

}  // namespace
}  // namespace talus
