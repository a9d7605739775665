#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/scenes.hpp"
#include "talus/physics/impact.hpp"

namespace talus {
namespace {

constexpr int kDraws = 1'000'000;
constexpr double kShareBelow = 0.15865525393145707;  // P(N < -1)
constexpr double kDensity = 0.24197072451914337;     // of N at 1

Asperity draw(std::uint32_t block, std::uint32_t event, const Ground& ground, Roughness rule) {
  return Asperities(Random(5, 1, block, Purpose::Impact), rule).at(event, ground);
}

std::vector<double> tan_thetas(Roughness rule) {
  const Ground ground{.theta_scale = 1.0};
  std::vector<double> values;
  for (std::uint32_t block = 0; block < kDraws / 8; ++block) {
    Asperities asperities(Random(5, 1, block, Purpose::Impact), rule);
    for (std::uint32_t event = 0; event < 8; ++event) values.push_back(asperities.at(event, ground).tan_theta);
  }
  std::sort(values.begin(), values.end());
  return values;
}

double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}
double quantile(const std::vector<double>& sorted, double p) {
  return sorted[static_cast<std::size_t>(p * kDraws)];
}

/// 5 standard errors of a quantile p of a variable whose density there is f.
double bound(double p, double f) {
  return 5.0 * std::sqrt(p * (1.0 - p) / kDraws) / f;
}

TEST(Asperity,
     ClampedBracket) {  // max(0, 0.5 + 0.5 N): mean (Phi(1) + phi(1)) / 2 = 0.542, P95 1.322 (docs/physics.md 4)
  const auto x = tan_thetas(Roughness::Clamp);
  EXPECT_NEAR(mean(x), 0.5 * (1.0 - kShareBelow + kDensity), 5.0 * 0.43 / std::sqrt(kDraws));
  EXPECT_NEAR(quantile(x, 0.95), 0.5 + 0.5 * 1.6448536269514722, bound(0.95, 2.0 * 0.10313564));
  EXPECT_NEAR(quantile(x, 0.5), 0.5, bound(0.5, 2.0 * 0.39894228));
  const auto zeros = std::count(x.begin(), x.end(), 0.0);
  EXPECT_NEAR(static_cast<double>(zeros) / kDraws, kShareBelow, bound(kShareBelow, 1.0));
  EXPECT_GE(x.front(), 0.0);
}

TEST(Asperity, ResampledBracket) {  // N given N > -1: mean 0.5 + 0.5 phi(1)/Phi(1) = 0.644, P95 1.363
  const auto x = tan_thetas(Roughness::Resample);
  EXPECT_NEAR(mean(x), 0.5 + 0.5 * kDensity / (1.0 - kShareBelow), 5.0 * 0.40 / std::sqrt(kDraws));
  EXPECT_NEAR(quantile(x, 0.95), 1.363, 0.0005 + bound(0.95, 2.0 * 0.0899 / (1.0 - kShareBelow)));
  EXPECT_GT(x.front(), 0.0);
}

TEST(Asperity, PsiIsSymmetricWithHalfAStandardDeviationAndIndependentOfTheta) {
  const Ground ground{.theta_scale = 1.0, .psi_scale = 1.0, .shape_min = 1.0, .shape_max = 1.5};
  double sum = 0, squares = 0, cross = 0, shape = 0, shapes = 0, heading = 0;
  for (std::uint32_t block = 0; block < kDraws / 4; ++block) {
    Asperities asperities(Random(6, 1, block, Purpose::Impact), Roughness::Clamp);
    for (std::uint32_t event = 0; event < 4; ++event) {
      const Asperity a = asperities.at(event, ground);
      sum += a.tan_psi, squares += a.tan_psi * a.tan_psi, cross += a.tan_psi * a.tan_theta;
      shape += a.shape, shapes += (a.shape - 1.25) * (a.shape - 1.25), heading += a.heading;
      ASSERT_TRUE(a.shape > 1.0 && a.shape < 1.5 && a.heading > 0.0 && a.heading < 1.0);
    }
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 5.0 * 0.5 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 0.25, 5.0 * 0.25 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(cross / kDraws, 0.0, 5.0 * 0.5 * 0.7 / std::sqrt(kDraws));
  EXPECT_NEAR(shape / kDraws, 1.25, 5.0 * 0.5 / std::sqrt(12.0 * kDraws));
  EXPECT_NEAR(shapes / kDraws, 0.25 / 12.0, 5.0 * 0.25 * std::sqrt(1.0 / 180.0 / kDraws));
  EXPECT_NEAR(heading / kDraws, 0.5, 5.0 / std::sqrt(12.0 * kDraws));
}

TEST(Asperity, ScalesMultiplyAndZeroIsSmooth) {
  for (std::uint32_t block = 0; block < 1000; ++block) {
    const Asperity one = draw(block, 2, {.theta_scale = 1.0, .psi_scale = 1.0}, Roughness::Clamp);
    const Asperity other = draw(block, 2, {.theta_scale = 0.7, .psi_scale = 0.25}, Roughness::Clamp);
    EXPECT_NEAR(other.tan_theta, 0.7 * one.tan_theta, 1e-15);
    EXPECT_EQ(other.tan_psi, 0.25 * one.tan_psi);
    const Asperity smooth = draw(block, 2, {}, Roughness::Clamp);
    EXPECT_EQ(smooth.tan_theta, 0.0);
    EXPECT_EQ(smooth.tan_psi, 0.0);
    EXPECT_EQ(smooth.shape, 1.0);
  }
}

TEST(Asperity, TheRuleChangesNothingButTheNegativeAngles) {  // a redraw must not shift other draws
  const Ground ground{.theta_scale = 1.0, .psi_scale = 1.0, .shape_min = 1.0, .shape_max = 1.5};
  int redrawn = 0;
  for (std::uint32_t block = 0; block < 200; ++block)
    for (std::uint32_t event = 0; event < 20; ++event) {
      const Asperity clamp = draw(block, event, ground, Roughness::Clamp),
                     other = draw(block, event, ground, Roughness::Resample);
      EXPECT_EQ(clamp.tan_psi, other.tan_psi);
      EXPECT_EQ(clamp.shape, other.shape);
      EXPECT_EQ(clamp.heading, other.heading);
      if (clamp.tan_theta > 0.0) {
        EXPECT_EQ(clamp.tan_theta, other.tan_theta);
      } else {
        EXPECT_GT(other.tan_theta, 0.0);
        ++redrawn;
      }
    }
  EXPECT_GT(redrawn, 500);
}

TEST(Asperity, DependsOnTheNumberOfTheImpactOnlyNotOnTheOrder) {
  const Ground ground{.theta_scale = 1.0, .psi_scale = 1.0, .shape_min = 1.0, .shape_max = 1.5};
  Asperities one(Random(8, 1, 3, Purpose::Impact), Roughness::Resample);
  for (const std::uint32_t event : {0U, 1U, 7U, 8U, 9U, 3U, 100U, 99'999U, 15U, 16U, 0U}) {
    const Asperity kept = one.at(event, ground),
                   fresh = Asperities(Random(8, 1, 3, Purpose::Impact), Roughness::Resample).at(event, ground);
    EXPECT_EQ(kept.tan_theta, fresh.tan_theta) << event;
    EXPECT_EQ(kept.tan_psi, fresh.tan_psi) << event;
    EXPECT_EQ(kept.shape, fresh.shape) << event;
  }
}

}  // namespace
}  // namespace talus
