#include "talus/simulate/tally/cell_record.hpp"

#include <algorithm>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

std::int64_t fixed_point(float value, double units) {
  return static_cast<std::int64_t>(static_cast<double>(value) * units + 0.5);
}

}  // namespace

void CellValues::make_room(std::size_t n) {
  if (keep_stakes && stakes.size() < n) stakes.resize(n);
  if (lists.front().size() < n)
    for (std::vector<float>& list : lists) list.resize(n);
}

double CellRecord::mean(Quantity quantity) const {
  const double unit = kQuantityTable[index_of(quantity)].fixed_point;
  return passages == 0 ? 0.0 : static_cast<double>(sum[quantity]) * unit / passages;
}

PerQuantity<float> CellRecord::add(const CellValues& values) {
  passages += static_cast<std::uint32_t>(values.count);
  PerQuantity<float> largest{};
  for_each_quantity([&](auto q) {
    constexpr double kUnits = 1.0 / kQuantityTable[q].fixed_point;
    const float* const list = values.lists[q].data();
    std::int64_t added = 0;
    float most = 0.0F;
#pragma omp simd reduction(+ : added) reduction(max : most)
    for (std::size_t i = 0; i < values.count; ++i) {
      added += fixed_point(list[i], kUnits);
      most = std::max(most, list[i]);
    }
    sum[q] += added;
    largest[q] = most;
    maximum[q] = std::max(maximum[q], most);
    histogram[q].add({list, values.count});
  });
  return largest;
}

void CellRecord::merge(const CellRecord& other) {
  impacts += other.impacts;
  length += other.length;
  length_squares += other.length_squares;
  passages += other.passages;
  sources += other.sources;
  deposits += other.deposits;
  trapped += other.trapped;
  exits += other.exits;
  for (std::size_t q = 0; q < kQuantities; ++q) {
    maximum[q] = std::max(maximum[q], other.maximum[q]);
    sum[q] += other.sum[q];
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
