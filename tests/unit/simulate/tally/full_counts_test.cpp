#include <gtest/gtest.h>

#include <limits>

#include "talus/simulate/tally/cell_record.hpp"
#include "talus/simulate/tally/checked_sum.hpp"
#include "talus/simulate/tally/hazard_tally.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kPassagesAt = 3 * sizeof(std::int64_t);  // in the bytes of a record

/// A histogram of one bin with this count, from bytes as `save` writes them.
LogHistogram histogram_of(std::uint32_t count) {
  ByteWriter out;
  out.put(std::uint8_t{0});      // few values
  out.put(std::uint16_t{8});     // bins
  out.put(std::uint16_t{2032});  // key of the first: 1.0
  out.put(std::uint8_t{4});      // bytes of a count
  std::vector<std::uint32_t> counts(8, 0);
  counts[0] = count;
  out.put(std::uint64_t{32});
  for (const std::uint32_t n : counts) out.put(n);
  ByteReader in(out.bytes());
  return LogHistogram::restored(in);
}

CellRecord record_of(std::uint32_t passages) {
  ByteWriter out;
  CellRecord().save(out);
  std::string bytes = out.bytes();
  std::memcpy(bytes.data() + kPassagesAt, &passages, sizeof passages);
  ByteReader in(bytes);
  return CellRecord::restored(in);
}

TEST(CheckedSum, FitsOrIsRefused) {
  std::uint32_t count = kMost - 1;
  add_checked(count, 1U);
  EXPECT_EQ(count, kMost);
  EXPECT_THROW(add_checked(count, 1U), InputError);
  std::int64_t sum = std::numeric_limits<std::int64_t>::max();
  EXPECT_THROW(add_checked(sum, std::int64_t{1}), InputError);
}

TEST(FullCounts, OfAHistogram) {
  LogHistogram h = histogram_of(kMost - 2);
  h.merge(histogram_of(2));
  EXPECT_EQ(h.count(), kMost);  // all of them in one bin
  EXPECT_THROW(h.merge(histogram_of(1)), InputError);
  LogHistogram high;  // merging it drops the lowest bins of `h` into one
  for (int i = 0; i < 10; ++i) high.add(std::vector<float>{1e6F});
  high.merge(h);
  EXPECT_EQ(high.count(), std::uint64_t{kMost} + 10);
}

TEST(FullCounts, OfACell) {
  CellRecord record = record_of(kMost);
  EXPECT_EQ(record.passages, kMost);
  EXPECT_THROW(record.merge(record_of(1)), InputError);
  CellValues values;
  values.make_room(1);
  values.count = 1;
  record = record_of(kMost);
  EXPECT_THROW(record.add(values), InputError);
}

/// Counts of 8 bits that are full at 255, of one quantity before the others: the histograms of a cell, which are
/// counted together, are those that are filled one by one, and hold every value.
TEST(FullCounts, OfHistogramsThatAreCountedTogether) {
  CellRecord record;
  CellValues values;
  values.make_room(200);
  values.count = 200;
  PerQuantity<LogHistogram> alone;
  for (std::size_t q = 0; q < kQuantities; ++q)
    for (std::size_t i = 0; i < 200; ++i) values.lists[q][i] = q == 0 || i % q == 0 ? 5.0F : static_cast<float>(i + 1);
  for (int batch = 0; batch < 4; ++batch) {
    record.add(values);
    for (std::size_t q = 0; q < kQuantities; ++q) alone[q].add({values.lists[q].data(), values.count});
  }
  for (std::size_t q = 0; q < kQuantities; ++q) {
    ByteWriter together, one_by_one;
    record.histogram[q].save(together);
    alone[q].save(one_by_one);
    EXPECT_EQ(record.histogram[q].count(), 800U);
    EXPECT_EQ(together.bytes(), one_by_one.bytes());
  }
}

TEST(ForgedBytes, OfAHistogramBeyondTheLargestNumber) {
  for (const std::uint16_t first : {std::uint16_t{4096}, std::uint16_t{65535}}) {
    ByteWriter out;
    out.put(std::uint8_t{0});
    out.put(std::uint16_t{8});
    out.put(first);
    out.put(std::uint8_t{1});
    out.put(std::uint64_t{8});
    out.put(std::uint64_t{0});
    ByteReader in(out.bytes());
    EXPECT_THROW(LogHistogram::restored(in), std::out_of_range) << first;
  }
}

TEST(ForgedBytes, OfAHazardCellWithOtherBins) {
  const HazardRules rules{EnergyBins({30.0, 300.0}), {}};
  for (const int first : {-1, 2'000'000'000, rules.bins.count()}) {
    ByteWriter out;
    out.put(first);
    out.put(std::uint64_t{1});
    out.put(HazardCell::Bin{});
    out.put(std::uint64_t{0});
    out.put(std::uint64_t{0});
    ByteReader in(out.bytes());
    EXPECT_THROW(HazardCell::restored(rules, in), std::out_of_range) << first;
  }
}

}  // namespace
}  // namespace talus
