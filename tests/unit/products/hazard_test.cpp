#include "talus/products/hazard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "talus/products/interval.hpp"

namespace talus {
namespace {

/// A run of `n` trajectories that stand for 2^-10 events per year each; units and squares without rounding.
HazardRules rules_of(std::uint64_t n, bool equal) {
  WeightScale scale{0x1p-40, 0x1p-60, static_cast<double>(n) * 0x1p-10, std::int64_t{1} << 30, n, equal};
  return {EnergyBins({30.0, 300.0}), scale};
}

/// A cell that these energies were counted in [kJ], each with the largest weight.
HazardCell cell_of(const HazardRules& rules, const std::vector<float>& energies) {
  HazardCell cell;
  for (const float energy : energies)
    cell.merge(
        HazardCell::restored(rules.bins.of(energy), {{std::int64_t{1} << 30, std::int64_t{1} << 40}}, {0, 0, 0}, {}));
  return cell;
}

std::vector<float> spread(int count) {  // from 1 to 2000 kJ, evenly in the logarithm
  std::vector<float> energies;
  for (int i = 0; i < count; ++i) energies.push_back(static_cast<float>(std::pow(2000.0, (i + 0.5) / count)));
  return energies;
}

/// Fay & Feuer's example, births of Down's syndrome: R package dsrTest 1.0, vignette, "Gamma Method": 75.52901
/// (67.70212, 188.30017) per 100 000.
TEST(GammaInterval, PublishedExample) {
  const std::vector<double> cases{0, 8, 63, 112, 262, 295}, births{327, 30666, 123419, 149919, 104088, 34392},
      standard{319933, 931318, 786511, 488235, 237863, 61313};
  const double all = std::accumulate(standard.begin(), standard.end(), 0.0);
  double sum = 0.0, squares = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double weight = standard[i] / (births[i] * all);
    sum += weight * cases[i];
    squares += weight * weight * cases[i];
    largest = std::max(largest, weight);
  }
  const Bounded interval = gamma_interval(sum, squares, largest);
  EXPECT_NEAR(1e5 * interval.value, 75.52901, 5e-6);
  EXPECT_NEAR(1e5 * interval.low, 67.70212, 5e-6);
  EXPECT_NEAR(1e5 * interval.high, 188.30017, 5e-6);
}

/// Equal weights: Poisson's exact bounds (Garwood 1936): 0 -> 0, 3.689; 5 -> 1.623, 11.668; 10 -> 4.795, 18.390.
TEST(GammaInterval, OfEqualWeightsIsGarwoods) {
  for (const auto& [k, low, high] : {std::tuple{0.0, 0.0, 3.689}, {5.0, 1.623, 11.668}, {10.0, 4.795, 18.390}}) {
    const Bounded interval = gamma_interval(0.1 * k, 0.01 * k, 0.1);
    EXPECT_NEAR(interval.low, 0.1 * low, 1e-4);
    EXPECT_NEAR(interval.high, 0.1 * high, 1e-4);
  }
}

/// Clopper-Pearson of 10 in 100: 0.0490 to 0.1762 (their tables).
TEST(AnnualFrequency, OfEqualWeightsIsNoWiderThanClopperPearson) {
  const WeightScale scale{0x1p-40, 0x1p-60, 5.0, std::llround(0.05 * 0x1p40), 100, true};
  const double w = 0.05;
  const Bounded f = annual_frequency({10 * w, 10 * w * w, 0.0}, scale);
  EXPECT_NEAR(f.value, 0.5, 1e-9);
  EXPECT_NEAR(f.low, 5.0 * 0.0490, 5e-4);
  EXPECT_NEAR(f.high, 5.0 * 0.1762, 5e-4);
}

TEST(AnnualFrequency, ExactAtNoneAndAtAll) {
  for (const bool equal : {false, true}) {
    const HazardRules rules = rules_of(100, equal);
    const double w = rules.scale.largest_weight();
    const Bounded none = annual_frequency({}, rules.scale),
                  all = annual_frequency({100 * w, 100 * w * w, 0.0}, rules.scale);
    EXPECT_EQ(none.value, 0.0);
    EXPECT_EQ(none.low, 0.0);
    EXPECT_NEAR(none.high, w * (equal ? 100 * (1 - std::pow(0.025, 0.01)) : -std::log(0.025)), 1e-9);
    EXPECT_EQ(all.high, rules.scale.total);
    EXPECT_EQ(all.value, rules.scale.total);
    EXPECT_LT(all.low, all.value);
  }
}

TEST(AnnualFrequency, OfWeightsThatAreTinyBesideTheLargest) {
  WeightScale scale = rules_of(100, false).scale;
  for (const double share : {1e-3, 1e-6, 1e-9}) {
    const double w = scale.largest_weight();
    const Bounded f = annual_frequency({share * w, scale.square_unit, 0.0}, scale);
    EXPECT_GE(f.low, 0.0);
    EXPECT_LE(f.low, f.value);
    EXPECT_NEAR(f.high, 3.689 * w, 0.01 * w);
  }
}

/// Source cells that hit with probabilities of their own, weights and number of blocks: how often the bounds miss.
struct Strata {
  const char* what;
  std::vector<double> probabilities, weights;
  int blocks;
};

double missed(const Strata& strata, int trials, std::mt19937_64& engine) {
  double total = 0.0, truth = 0.0, largest = 0.0;
  bool equal = true;
  for (std::size_t i = 0; i < strata.weights.size(); ++i) {
    total += strata.weights[i] * strata.blocks;
    truth += strata.weights[i] * strata.blocks * strata.probabilities[i];
    largest = std::max(largest, strata.weights[i]);
    equal = equal && strata.weights[i] == strata.weights[0];
  }
  const std::uint64_t n = strata.weights.size() * static_cast<std::uint64_t>(strata.blocks);
  const WeightScale scale{largest * 0x1p-40, 0.0, total, std::int64_t{1} << 40, n, equal};
  int misses = 0;
  for (int trial = 0; trial < trials; ++trial) {
    WeightSums sums;
    for (std::size_t i = 0; i < strata.weights.size(); ++i) {
      std::binomial_distribution<int> draw(strata.blocks, strata.probabilities[i]);
      const double k = draw(engine), w = strata.weights[i];
      sums.sum += k * w;
      sums.squares += k * w * w;
      sums.overlap += (k * k - k) * w * w / (strata.blocks - 1);
    }
    const Bounded f = annual_frequency(sums, scale);
    misses += f.low > truth * (1 + 1e-9) || f.high < truth * (1 - 1e-9);
  }
  return static_cast<double>(misses) / trials;
}

std::vector<double> many(std::size_t count, double value) {
  return std::vector<double>(count, value);
}

std::vector<double> joined(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// At least 95 % for very different source cells. At most 5 % may miss; 4000 trials, so 5.0 + 5 * 0.34 % is the bound.
TEST(AnnualFrequency, BoundsOfStrataCoverAtLeast95Percent) {
  std::mt19937_64 engine(11);
  const std::vector<double> ramp{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0},
      steep{1, 1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 30};
  for (const int blocks : {5, 20, 100})
    for (const Strata& strata :
         {Strata{"one of a half", {0.5}, {1.0}, blocks},
          {"one almost sure", {0.963}, {1.0}, blocks},
          {"one rare", {0.01}, {1.0}, blocks},
          {"a ramp", ramp, many(11, 1.0), blocks},
          {"a ramp, weights with it", ramp, steep, blocks},
          {"half almost sure", joined(many(10, 0.98), many(10, 0.02)), many(20, 1.0), blocks},
          {"one sure among rare", joined({0.97}, many(200, 0.002)), many(201, 1.0), blocks},
          {"heavy and rare", joined({0.01}, many(50, 0.6)), joined({30.0}, many(50, 1.0)), blocks},
          {"heavy and sure", joined({0.99}, many(50, 0.05)), joined({30.0}, many(50, 1.0)), blocks},
          {"all rare", many(100, 0.002), many(100, 1.0), blocks}})
      EXPECT_LE(missed(strata, 4000, engine), 0.05 + 5.0 * std::sqrt(0.05 * 0.95 / 4000))
          << strata.what << ' ' << blocks;
}

/// Strata make the bounds much narrower in cells that nearly every block of some sources reaches.
TEST(AnnualFrequency, StrataMakeTheBoundsNarrower) {
  const HazardRules rules = rules_of(2000, true);
  const double w = rules.scale.largest_weight();  // 10 sources of 100 that always hit, 10 that never do
  const Bounded alone = annual_frequency({1000 * w, 1000 * w * w, 0.0}, rules.scale),
                strata = annual_frequency({1000 * w, 1000 * w * w, 10 * (100 * 100 - 100) / 99.0 * w * w}, rules.scale);
  EXPECT_LT(strata.high - strata.low, 0.1 * (alone.high - alone.low));
}

TEST(HazardCurve, FallsWithTheEnergy) {
  const HazardRules rules = rules_of(100'000, true);
  const HazardCurve curve(rules, cell_of(rules, spread(500)));
  for (std::size_t i = 0; i < curve.size() - 1; ++i) {
    EXPECT_GE(curve.at(i).value, curve.at(i + 1).value);
    EXPECT_GE(curve.at(i).low, curve.at(i + 1).low);
    EXPECT_GE(curve.at(i).high, curve.at(i + 1).high);
    EXPECT_LE(curve.at(i).low, curve.at(i).value);
    EXPECT_GE(curve.at(i).high, curve.at(i).value);
  }
  EXPECT_EQ(curve.at(curve.size() - 1).value, 0.0);
  double before = curve.passage().value;
  for (double energy = 0.5; energy < 3000.0; energy *= 1.03) {
    const double here = curve.exceedance_of(energy).value;
    EXPECT_LE(here, before * (1 + 1e-12));
    before = here;
  }
}

TEST(HazardCurve, ThresholdsAreExact) {
  const HazardRules rules = rules_of(1000, true);
  const HazardCurve curve(rules, cell_of(rules, {1.0F, 29.9F, 30.0F, 30.1F, 299.0F, 300.1F}));
  EXPECT_DOUBLE_EQ(curve.passage().value, 6 * 0x1p-10);
  EXPECT_DOUBLE_EQ(curve.exceedance(0).value, 3 * 0x1p-10);
  EXPECT_DOUBLE_EQ(curve.exceedance(1).value, 1 * 0x1p-10);
  EXPECT_DOUBLE_EQ(curve.exceedance_of(30.0).value, 3 * 0x1p-10);
}

TEST(HazardCurve, ReturnPeriodTimesFrequencyIsOne) {
  const HazardRules rules = rules_of(1000, true);
  const HazardCurve curve(rules, cell_of(rules, spread(40)));
  const Bounded f = curve.exceedance(0), t = return_period(f);
  EXPECT_DOUBLE_EQ(f.value * t.value, 1.0);
  EXPECT_DOUBLE_EQ(f.low * t.high, 1.0);
  EXPECT_DOUBLE_EQ(f.high * t.low, 1.0);
  EXPECT_TRUE(std::isinf(return_period({}).value));
}

/// The k-th largest of the energies is exceeded k - 1 times: the curve's inverse is within a bin of it.
TEST(HazardCurve, EnergyOnceInAPeriodIsTheQuantile) {
  const HazardRules rules = rules_of(100'000, true);
  const std::vector<float> energies = spread(500);
  const HazardCurve curve(rules, cell_of(rules, energies));
  for (const std::size_t rank : {5U, 50U, 300U, 480U}) {
    const double years = 1024.0 / static_cast<double>(rank);
    const Bounded energy = curve.energy_once_in(years);
    EXPECT_NEAR(energy.value / energies[500 - rank], 1.0, 0.125) << rank;
    EXPECT_LE(energy.low, energy.value);
    EXPECT_GE(energy.high, energy.value);
    EXPECT_NEAR(curve.exceedance_of(energy.value).value * years, 1.0, 1e-6);
  }
  EXPECT_EQ(curve.energy_once_in(1.0).value, 0.0) << "less than once a year anything passes";
  EXPECT_TRUE(std::isinf(curve.energy_once_in(1e6).high)) << "so rare that nothing bounds it";
}

TEST(HazardCurve, OfAnEmptyCell) {
  const HazardRules rules = rules_of(1000, false);
  const HazardCurve curve(rules, HazardCell());
  EXPECT_EQ(curve.passage().value, 0.0);
  EXPECT_NEAR(curve.passage().high, 3.689 * 0x1p-10, 1e-5);
  EXPECT_EQ(curve.exceedance_of(30.0).value, 0.0);
  EXPECT_EQ(curve.energy_once_in(100.0).value, 0.0);
}

}  // namespace
}  // namespace talus
