#include "talus/simulate/tally/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "support/percentile.hpp"
#include "support/scenes.hpp"

namespace talus {
namespace {

using test::Numbers;
using Values = std::vector<float>;

constexpr double kShares[] = {0.0, 0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 0.999, 1.0};

/// The values in pieces of random sizes up to `most`, in their order.
void add_in_pieces(LogHistogram& histogram, std::span<const float> values, std::size_t most, Numbers& numbers) {
  while (!values.empty()) {
    const std::size_t n = std::min<std::size_t>(values.size(), 1 + numbers.bits() % most);
    histogram.add(values.first(n));
    values = values.subspan(n);
  }
}

void shuffle(Values& values, Numbers& numbers) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[numbers.bits() % i]);
}

/// Checks the error bound of the header against the sorted values.
void expect_within_bound(Values values, const LogHistogram& histogram, const char* what) {
  std::sort(values.begin(), values.end());
  ASSERT_EQ(histogram.count(), values.size()) << what;
  const double apart = std::max<double>(LogHistogram::kFloor, values.back() / 128.0);  // smaller ones share a bin
  const auto n = static_cast<double>(values.size());
  std::array<double, std::size(kShares)> together{};
  histogram.percentiles(kShares, together);
  for (std::size_t i = 0; i < together.size(); ++i)
    ASSERT_EQ(together[i], test::percentile(histogram, kShares[i])) << what;
  for (const double share : kShares) {
    const auto k = static_cast<std::size_t>(std::clamp(std::ceil(share * n), 1.0, n));
    const double exact = values[k - 1], found = test::percentile(histogram, share);
    if (exact >= apart)
      ASSERT_NEAR(found, exact, LogHistogram::kBinWidth * exact) << what << " n=" << n << " share=" << share;
    else
      ASSERT_LT(found, apart * (1.0 + LogHistogram::kBinWidth)) << what << " n=" << n << " share=" << share;
    ASSERT_GE(found, 0.0) << what << " n=" << n << " share=" << share;
  }
}

struct Distribution {
  const char* name;
  std::function<double(Numbers&)> draw;
};

std::vector<Distribution> distributions() {
  return {{"constant", [](Numbers&) { return 17.3; }},
          {"uniform", [](Numbers& r) { return r.uniform(0.0, 40.0); }},
          {"exponential", [](Numbers& r) { return -3.0 * std::log(1.0 - r.uniform(0.0, 1.0)); }},
          {"nine decades", [](Numbers& r) { return std::pow(10.0, r.uniform(-3.0, 6.0)); }},
          {"log-normal", [](Numbers& r) { return std::exp(2.0 * r.normal()); }},
          {"two clusters",
           [](Numbers& r) { return r.uniform(0.0, 1.0) < 0.7 ? r.uniform(1.0, 1.1) : r.uniform(50.0, 60.0); }},
          {"half zero", [](Numbers& r) { return r.uniform(0.0, 1.0) < 0.5 ? 0.0 : r.uniform(0.0, 3.0); }},
          {"zero", [](Numbers&) { return 0.0; }},
          {"edges of bins",
           [](Numbers& r) {
             return std::ldexp(16.0 + static_cast<double>(r.bits() % 16), static_cast<int>(r.bits() % 6));
           }},
          {"one large", [](Numbers& r) { return r.uniform(0.0, 1.0) < 0.001 ? 9e6 : r.uniform(1.0, 2.0); }},
          {"denormal to huge", [](Numbers& r) { return std::pow(10.0, r.uniform(-42.0, 37.0)); }}};
}

Values draw(const Distribution& distribution, std::size_t n, Numbers& numbers) {
  Values values(n);
  for (float& value : values) value = static_cast<float>(distribution.draw(numbers));
  return values;
}

TEST(LogHistogram, PercentilesStayWithinTheStatedBound) {
  Numbers numbers(1);
  for (const Distribution& distribution : distributions())
    for (const std::size_t n : {1U, 2U, 5U, 6U, 7U, 255U, 256U, 1000U}) {
      const Values values = draw(distribution, n, numbers);
      for (const std::size_t most : {std::size_t{1}, std::size_t{50}, n}) {
        LogHistogram histogram;
        add_in_pieces(histogram, values, most, numbers);
        expect_within_bound(values, histogram, distribution.name);
      }
    }
}

TEST(LogHistogram, HoldsTheBoundWithCountsOfEveryWidth) {  // 300 000 need 16 and 32 bits
  Numbers numbers(2);
  for (const Distribution& distribution : distributions()) {
    const Values values = draw(distribution, 300'000, numbers);
    LogHistogram histogram;
    add_in_pieces(histogram, values, 3000, numbers);
    expect_within_bound(values, histogram, distribution.name);
  }
}

TEST(LogHistogram, NoCountIsLostWhenABinIsFull) {
  for (const std::size_t n : {254U, 255U, 256U, 257U, 65'534U, 65'535U, 65'536U, 65'537U}) {
    LogHistogram histogram;
    const float other[] = {10.0F, 20.0F, 20.0F};
    histogram.add(other);
    for (std::size_t i = 0; i < n; ++i) histogram.add(std::array{3.0F});
    histogram.add(other);
    ASSERT_EQ(histogram.count(), n + 6);
    const auto all = static_cast<double>(n + 6), count = static_cast<double>(n);
    EXPECT_NEAR(test::percentile(histogram, (count - 0.5) / all), 3.0, 3.0 * 0.0625) << n;  // the last 3
    EXPECT_NEAR(test::percentile(histogram, (count + 0.5) / all), 10.0, 10.0 * 0.0625) << n;
    EXPECT_NEAR(test::percentile(histogram, (count + 2.5) / all), 20.0, 20.0 * 0.0625) << n;
  }
}

TEST(LogHistogram, InterpolatesWithinABin) {  // 1000 values evenly in the bin [1, 1.0625): exact but for rounding
  Values values(1000);
  for (std::size_t i = 0; i < 1000; ++i)
    values[i] = static_cast<float>(1.0 + 0.0625 * (static_cast<double>(i) + 0.5) / 1000.0);
  LogHistogram histogram;
  histogram.add(values);
  for (int k = 1; k <= 1000; ++k)
    ASSERT_NEAR(test::percentile(histogram, (k - 0.5) / 1000.0), values[static_cast<std::size_t>(k - 1)], 1e-7) << k;
}

TEST(LogHistogram, PercentileIsMonotoneInTheShare) {
  Numbers numbers(3);
  for (const Distribution& distribution : distributions()) {
    LogHistogram histogram;
    histogram.add(draw(distribution, 500, numbers));
    double last = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double now = test::percentile(histogram, i / 1000.0);
      ASSERT_GE(now, last) << distribution.name << ' ' << i;
      last = now;
    }
  }
}

/// Checks for equal counts and equal bits of every percentile.
void expect_same(const LogHistogram& a, const LogHistogram& b, const char* what) {
  ASSERT_EQ(a.count(), b.count()) << what;
  for (int i = 0; i <= 200; ++i) {
    const double left = test::percentile(a, i / 200.0), right = test::percentile(b, i / 200.0);
    ASSERT_TRUE(left == right || (std::isnan(left) && std::isnan(right)))
        << what << ' ' << i << ' ' << left << ' ' << right;
  }
}

/// The histogram of the values in another order and in other pieces, from several histograms merged in another order.
LogHistogram split_and_merged(Values values, Numbers& numbers) {
  shuffle(values, numbers);
  std::vector<LogHistogram> parts(1 + numbers.bits() % 5);
  for (const float value : values) parts[numbers.bits() % parts.size()].add(std::array{value});
  LogHistogram whole;
  add_in_pieces(whole, {}, 1, numbers);
  while (!parts.empty()) {
    const auto pick = parts.begin() + static_cast<std::ptrdiff_t>(numbers.bits() % parts.size());
    if (parts.size() > 1 && numbers.bits() % 2 == 0) {
      LogHistogram& next = pick == parts.begin() ? parts.back() : parts.front();
      next.merge(*pick);
    } else {
      whole.merge(*pick);
    }
    parts.erase(pick);
  }
  return whole;
}

TEST(LogHistogram, StateDependsOnTheMultisetOnly) {
  Numbers numbers(4);
  for (const Distribution& distribution : distributions())
    for (const std::size_t n : {1U, 2U, 3U, 5U, 6U, 11U, 100U, 3000U}) {
      const Values values = draw(distribution, n, numbers);
      LogHistogram at_once;
      at_once.add(values);
      for (int trial = 0; trial < 8; ++trial)
        expect_same(split_and_merged(values, numbers), at_once, distribution.name);
    }
}

TEST(LogHistogram, SavedBytesDoNotDependOnTheOrder) {
  const auto saved = [](const Values& values) {
    LogHistogram histogram;
    for (const float value : values) histogram.add(std::array{value});
    ByteWriter out;
    histogram.save(out);
    return out.bytes();
  };
  EXPECT_EQ(saved({1.0F, 8.0F, 3.0F}), saved({8.0F, 3.0F, 1.0F}));
}

TEST(LogHistogram, RisingAndFallingValuesGiveTheSame) {  // the low end collapses step by step, or at once
  Numbers numbers(5);
  Values values = draw(distributions()[3], 20'000, numbers);
  std::sort(values.begin(), values.end());
  LogHistogram rising, falling;
  for (const float value : values) rising.add(std::array{value});
  std::reverse(values.begin(), values.end());
  for (const float value : values) falling.add(std::array{value});
  expect_same(rising, falling, "rising and falling");
  expect_within_bound(values, rising, "rising");
}

TEST(LogHistogram, CollapsedBinsOverflowIntoWiderCounts) {  // 40 bins of 200: their sum needs 16 bits
  Values values;
  for (int bin = 0; bin < 40; ++bin)
    for (int i = 0; i < 200; ++i) values.push_back(static_cast<float>(std::pow(2.0, (bin + 0.5) / 16.0)));
  LogHistogram histogram;
  histogram.add(values);
  histogram.add(std::array{1e5F});
  EXPECT_EQ(histogram.count(), 8001U);
  EXPECT_LE(test::percentile(histogram, 8000.0 / 8001.0), 1e5 / 128.0 * 1.0625);
  EXPECT_NEAR(test::percentile(histogram, 1.0), 1e5, 6250.0);
}

TEST(LogHistogram, ZeroAndTinyValuesCountAsTheFloor) {
  for (const float value : {0.0F, -0.0F, 1e-45F, 1e-30F, 0.0078F, -5.0F}) {
    LogHistogram histogram;
    histogram.add(std::vector<float>(10, value));
    EXPECT_EQ(histogram.count(), 10U);
    EXPECT_NEAR(test::percentile(histogram, 0.5), LogHistogram::kFloor, LogHistogram::kFloor * LogHistogram::kBinWidth);
  }
}

TEST(LogHistogram, NaNCountsAsTheFloorAndHidesNoOtherValue) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Values values{5.0F, 100.0F, 3.0F, 1.0F, 1e3F, 2.0F, 7.0F, 9.0F};
  for (std::size_t i = 0; i < values.size(); ++i) {
    Values with = values;
    with[i] = kNaN;
    LogHistogram histogram;
    histogram.add(with);
    EXPECT_EQ(histogram.count(), values.size());
    EXPECT_NEAR(test::percentile(histogram, 1.0), i == 4 ? 100.0 : 1e3, i == 4 ? 6.25 : 62.5) << i;
  }
}

TEST(LogHistogram, InfinityIsCountedAndBreaksNothing) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Values values(100, 5.0F);
  for (std::size_t i = 0; i < 100; i += 10) values[i] = kInfinity;
  LogHistogram histogram, other;
  Numbers numbers(6);
  add_in_pieces(histogram, values, 3, numbers);
  other.add(values);
  EXPECT_EQ(histogram.count(), 100U);
  expect_same(histogram, other, "infinity");
}

TEST(LogHistogram, EmptyIsZeroAndNeutral) {
  LogHistogram empty, histogram;
  EXPECT_EQ(empty.count(), 0U);
  EXPECT_EQ(test::percentile(empty, 0.5), 0.0);
  histogram.add(std::array{3.0F, 4.0F, 5.0F});
  const double before = test::percentile(histogram, 0.5);
  histogram.merge(empty);
  histogram.add({});
  EXPECT_EQ(histogram.count(), 3U);
  EXPECT_EQ(test::percentile(histogram, 0.5), before);
  empty.merge(histogram);
  expect_same(empty, histogram, "merged into nothing");
}

TEST(LogHistogram, MovesItsCounts) {
  LogHistogram from;
  from.add(std::vector<float>(1000, 2.0F));
  LogHistogram to(std::move(from));
  EXPECT_EQ(to.count(), 1000U);
  LogHistogram third;
  third.add(std::array{1.0F});
  third = std::move(to);
  EXPECT_EQ(third.count(), 1000U);
}

}  // namespace
}  // namespace talus
