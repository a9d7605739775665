#include "talus/simulate/tally/wide_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace talus {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();  // 2^64 - 1

WideSum sum_of(const std::vector<std::uint64_t>& numbers) {
  WideSum sum;
  for (const std::uint64_t number : numbers) sum += number;
  return sum;
}

TEST(WideSum, CarriesWhatIsAbove64Bits) {
  EXPECT_EQ(sum_of({}), WideSum{});
  EXPECT_EQ(sum_of({kLargest}), (WideSum{kLargest, 0}));
  EXPECT_EQ(sum_of({kLargest, 1}), (WideSum{0, 1}));
  EXPECT_EQ(sum_of({kLargest, kLargest, kLargest}), (WideSum{kLargest - 2, 2}));  // 3 (2^64 - 1) = 2 2^64 + 2^64 - 3
  EXPECT_EQ(static_cast<double>(sum_of(std::vector<std::uint64_t>(8, std::uint64_t{1} << 63U))), 0x1p66);
  EXPECT_EQ(static_cast<double>(sum_of({3, 4})), 7.0);
}

TEST(WideSum, IsTheSameInAnyOrderAndInParts) {
  std::vector<std::uint64_t> numbers{kLargest, 5, kLargest - 7, 1, std::uint64_t{1} << 63U, 0};
  const WideSum whole = sum_of(numbers);
  WideSum parts = sum_of({numbers[5], numbers[1], numbers[0]});
  parts += sum_of({numbers[4], numbers[3], numbers[2]});
  EXPECT_EQ(parts, whole);
  std::ranges::reverse(numbers);
  EXPECT_EQ(sum_of(numbers), whole);
}

}  // namespace
}  // namespace talus
