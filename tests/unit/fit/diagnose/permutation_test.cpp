#include "talus/fit/diagnose/permutation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace talus::test {
namespace {

/// Units with streams of their own, all in one stratum.
Units units_of(std::size_t n) {
  Units units{{}, std::vector<std::size_t>(n, 0)};
  for (std::size_t i = 0; i < n; ++i) units.streams.push_back(static_cast<std::uint32_t>(7919 * i + 13));
  return units;
}

/// Sum of products of the positions with the values that they are handed.
auto products_with(const std::vector<double>& y) {
  return [&y](std::span<const std::size_t> givers) {
    double sum = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += static_cast<double>(i) * y[givers[i]];
    return sum;
  };
}

TEST(Permutation, FewUnitsAreArrangedInEveryWayOnce) {
  Units units = units_of(5);
  units.strata = {0, 1, 0, 1, 0};
  const Arrangements ways(units, 100, 1);
  EXPECT_TRUE(ways.exact());
  ASSERT_EQ(ways.size(), 12U);  // 3! 2!
  std::set<std::vector<std::size_t>> different;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const auto givers = ways.givers(k);
    different.insert({givers.begin(), givers.end()});
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(units.strata[givers[i]], units.strata[i]);
  }
  EXPECT_EQ(different.size(), 12U);
}

TEST(Permutation, MoreWaysThanWereAskedForAreChosenFrom) {  // 5! = 120
  EXPECT_TRUE(Arrangements(units_of(5), 120, 1).exact());
  const Arrangements some(units_of(5), 119, 1);
  EXPECT_FALSE(some.exact());
  EXPECT_EQ(some.size(), 119U);
}

/// Whatever was measured, it is one of its own arrangements. Over all of them each p-value k/120 occurs at most as
/// often as it says, here exactly (all sums differ but for ties, which share the larger p).
TEST(Permutation, IsExactByEnumeration) {
  std::vector<double> y{0.3, 1.1, 2.7, 3.2, 9.4};
  const Arrangements ways(units_of(5), 1000, 1);
  ASSERT_EQ(ways.size(), 120U);
  std::vector<double> p_values;
  std::sort(y.begin(), y.end());
  do p_values.push_back(ways.test(products_with(y)).p_value);
  while (std::next_permutation(y.begin(), y.end()));
  ASSERT_EQ(p_values.size(), 120U);
  for (int k = 1; k <= 120; ++k) {
    const double alpha = k / 120.0 + 1e-12;
    EXPECT_LE(std::ranges::count_if(p_values, [&](double p) { return p <= alpha; }), k);
  }
  EXPECT_DOUBLE_EQ(std::ranges::min(p_values), 1.0 / 120.0);
  EXPECT_DOUBLE_EQ(std::ranges::max(p_values), 1.0);
}

TEST(Permutation, ARandomChoiceCountsWhatWasMeasuredOnceMore) {
  std::vector<double> y(20);
  std::iota(y.begin(), y.end(), 0.0);  // in order: no arrangement is as large
  const PermutationTest test = Arrangements(units_of(20), 500, 1).test(products_with(y));
  EXPECT_FALSE(test.exact);
  EXPECT_EQ(test.arrangements, 500U);
  EXPECT_DOUBLE_EQ(test.p_value, 1.0 / 500.0);
}

TEST(Permutation, HangsOnTheStreamsAndNotOnTheOrder) {
  std::vector<std::size_t> order(30);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::reverse(order.begin() + 3, order.begin() + 24);
  const Units units = units_of(30);
  Units other = units;
  for (std::size_t i = 0; i < 30; ++i) other.streams[i] = units.streams[order[i]];
  const Arrangements one(units, 50, 3), two(other, 50, 3), reseeded(units, 50, 4);
  int same = 0;
  for (std::size_t k = 0; k < 50; ++k)
    for (std::size_t i = 0; i < 30; ++i) {
      EXPECT_EQ(order[two.givers(k)[i]], one.givers(k)[order[i]]);
      same += one.givers(k)[i] == reseeded.givers(k)[i];
    }
  EXPECT_LT(same, 300);  // of 1500: 30 of the measured arrangement, one in thirty of the others
}

}  // namespace
}  // namespace talus::test
