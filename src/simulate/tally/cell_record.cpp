#include "talus/simulate/tally/cell_record.hpp"

#include <algorithm>

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

void EnergyTotal::add(std::span<const float> values) {
  const Sums sums = sums_of(values, 1.0 / kTotalUnit);
  add_checked(sum, sums.sum);
  maximum = std::max(maximum, sums.largest);
  histogram.add(values);
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
  PerQuantity<float> largest{};
  for_each_quantity([&](auto q) {
    constexpr double kUnits = 1.0 / kQuantityTable[q].fixed_point;
    const std::span<const float> list(values.lists[q].data(), values.count);
    const Sums sums = sums_of(list, kUnits);
    add_checked(sum[q], sums.sum);
    largest[q] = sums.largest;
    maximum[q] = std::max(maximum[q], sums.largest);
    histogram[q].add(list);
  });
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
