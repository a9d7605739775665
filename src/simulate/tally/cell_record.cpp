#include "talus/simulate/tally/cell_record.hpp"

#include <algorithm>
#include <limits>

#include "talus/base/expect.hpp"
#include "talus/simulate/tally/checked_sum.hpp"

namespace talus {
namespace {

/// Sum, in fixed point, and largest of some values.
struct Sums {
  std::int64_t sum = 0;
  float largest = 0.0F;
};

inline Sums sums_of(std::span<const float> values, double units) {
  std::int64_t sum = 0;
  float most = 0.0F;
#pragma omp simd reduction(+ : sum) reduction(max : most)
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += fixed_point(values[i], units);
    most = std::max(most, values[i]);
  }
  return {sum, most};
}

/// Sum, in fixed point, and range of the values of a quantity.
struct Summary {
  std::int64_t sum = 0;
  float least = std::numeric_limits<float>::infinity(), largest = 0.0F;
};

/// All quantities in one loop: most cells have few values, and the end of a loop costs more than a value.
PerQuantity<Summary> summaries_of(const CellValues& values) {
  PerQuantity<const float*> lists{};
  for_each_quantity([&](auto q) { lists[q] = values.lists[q].data(); });
  PerQuantity<Summary> summaries{};
  for (std::size_t i = 0; i < values.count; ++i)
    for_each_quantity([&](auto q) {
      constexpr double kUnits = 1.0 / kQuantityTable[q].fixed_point;
      const float value = lists[q][i];
      summaries[q].sum += fixed_point(value, kUnits);
      summaries[q].least = std::min(summaries[q].least, std::max(LogHistogram::kFloor, value));
      summaries[q].largest = std::max(summaries[q].largest, value);
    });
  return summaries;
}

/// Counts the values of all quantities in one loop: a count waits for the one before it only in its own histogram.
void count_together(PerQuantity<LogHistogram>& histograms, const PerQuantity<std::span<const float>>& values) {
  PerQuantity<const float*> lists{};
  PerQuantity<LogHistogram::Narrow> counts{};
  std::size_t most = values[0].size();
  for_each_quantity([&](auto q) {
    lists[q] = values[q].data();
    counts[q] = histograms[q].narrow();
    most = counts[q].counts == nullptr ? 0 : std::min(most, values[q].size());
  });
  std::size_t i = 0;
  for (; i < most; ++i) {
    PerQuantity<unsigned char*> here{};
    bool full = false;
    for_each_quantity([&](auto q) {
      here[q] = &counts[q].of(lists[q][i]);
      full = full || *here[q] == 0xFFU;
    });
    if (full) break;
    for_each_quantity([&](auto q) { ++*here[q]; });
  }
  for_each_quantity([&](auto q) { histograms[q].count_all(values[q].subspan(i)); });
}

constexpr double kTotalUnit = kQuantityTable[index_of(Quantity::Energy)].fixed_point;

}  // namespace

void CellValues::make_room(std::size_t n) {
  if (keep_annual_shares && annual_shares.size() < n) annual_shares.resize(n);
  if (keep_totals && totals.size() < n) totals.resize(n);
  if (lists.front().size() < n)
    for (std::vector<float>& list : lists) list.resize(n);
}

double EnergyTotal::mean() const {
  const std::uint64_t count = histogram.count();
  return count == 0 ? 0.0 : static_cast<double>(sum) * kTotalUnit / static_cast<double>(count);
}

float EnergyTotal::add(std::span<const float> values) {
  const Sums sums = sums_of(values, 1.0 / kTotalUnit);
  add_checked(sum, sums.sum);
  maximum = std::max(maximum, sums.largest);
  histogram.add(values);
  return sums.largest;
}

void EnergyTotal::merge(const EnergyTotal& other) {
  maximum = std::max(maximum, other.maximum);
  add_checked(sum, other.sum);
  histogram.merge(other.histogram);
}

void EnergyTotal::save(ByteWriter& out) const {
  out.put(maximum);
  out.put(sum);
  histogram.save(out);
}

EnergyTotal EnergyTotal::restored(ByteReader& in) {
  EnergyTotal total;
  total.maximum = in.get<float>();
  total.sum = in.get<std::int64_t>();
  total.histogram = LogHistogram::restored(in);
  return total;
}

double CellRecord::mean(Quantity quantity) const {
  const double unit = kQuantityTable[index_of(quantity)].fixed_point;
  return passages == 0 ? 0.0 : static_cast<double>(sum[quantity]) * unit / passages;
}

PerQuantity<float> CellRecord::add(const CellValues& values) {
  add_checked(passages, static_cast<std::uint32_t>(values.count));  // no other count of the cell is larger
  const PerQuantity<Summary> summaries = summaries_of(values);
  PerQuantity<float> largest{};
  PerQuantity<std::span<const float>> left{};
  for_each_quantity([&](auto q) {
    const Summary& summary = summaries[q];
    add_checked(sum[q], summary.sum);
    largest[q] = summary.largest;
    maximum[q] = std::max(maximum[q], summary.largest);
    left[q] = histogram[q].make_room({values.lists[q].data(), values.count}, summary.least,
                                     std::max(LogHistogram::kFloor, summary.largest));
  });
  count_together(histogram, left);
  return largest;
}

void CellRecord::merge(const CellRecord& other) {
  add_checked(impacts, other.impacts);
  add_checked(length, other.length);
  add_checked(length_squares, other.length_squares);
  add_checked(passages, other.passages);
  add_checked(sources, other.sources);
  add_checked(deposits, other.deposits);
  add_checked(trapped, other.trapped);
  add_checked(exits, other.exits);
  for (std::size_t q = 0; q < kQuantities; ++q) {
    maximum[q] = std::max(maximum[q], other.maximum[q]);
    add_checked(sum[q], other.sum[q]);
    histogram[q].merge(other.histogram[q]);
    TALUS_EXPECT(histogram[q].count() == passages, "each passage is in the histogram once");
  }
  TALUS_EXPECT(trapped <= deposits, "a trapped block stays");
  TALUS_EXPECT(deposits <= passages, "what comes to rest in a cell has come there");
}

void CellRecord::save(ByteWriter& out) const {
  out.put(impacts);
  out.put(length);
  out.put(length_squares);
  for (const std::uint32_t count : {passages, sources, deposits, trapped, exits}) out.put(count);
  out.put(maximum);
  out.put(sum);
  for (const LogHistogram& h : histogram) h.save(out);
}

CellRecord CellRecord::restored(ByteReader& in) {
  CellRecord record;
  record.impacts = in.get<std::uint64_t>();
  record.length = in.get<std::int64_t>();
  record.length_squares = in.get<std::int64_t>();
  for (std::uint32_t* count : {&record.passages, &record.sources, &record.deposits, &record.trapped, &record.exits})
    *count = in.get<std::uint32_t>();
  record.maximum = in.get<PerQuantity<float>>();
  record.sum = in.get<PerQuantity<std::int64_t>>();
  for (LogHistogram& h : record.histogram) h = LogHistogram::restored(in);
  return record;
}

}  // namespace talus
