#include <algorithm>

#include "talus/base/expect.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

double CellRecord::mean(Quantity q) const {
  const auto i = static_cast<std::size_t>(q);
  return passages == 0 ? 0.0 : static_cast<double>(sum[i]) * kFixedPoint[i] / passages;
}

void CellRecord::merge(const CellRecord& other) {
  impacts += other.impacts;
  passages += other.passages;
  deposits += other.deposits;
  sources += other.sources;
  for (std::size_t q = 0; q < kQuantities; ++q) {
    maximum[q] = std::max(maximum[q], other.maximum[q]);
    sum[q] += other.sum[q];
    histogram[q].merge(other.histogram[q]);
    TALUS_EXPECT(histogram[q].count() == passages, "each passage is in the histogram once");
  }
  TALUS_EXPECT(deposits <= passages, "what comes to rest in a cell has come there");
}

void CellRecord::save(ByteWriter& out) const {
  out.put(impacts);
  out.put(passages);
  out.put(deposits);
  out.put(sources);
  out.put(maximum);
  out.put(sum);
  for (const LogHistogram& h : histogram) h.save(out);
}

CellRecord CellRecord::restored(ByteReader& in) {
  CellRecord record;
  record.impacts = in.get<std::uint64_t>();
  record.passages = in.get<std::uint32_t>();
  record.deposits = in.get<std::uint32_t>();
  record.sources = in.get<std::uint32_t>();
  record.maximum = in.get<std::array<float, kQuantities>>();
  record.sum = in.get<std::array<std::int64_t, kQuantities>>();
  for (LogHistogram& h : record.histogram) h = LogHistogram::restored(in);
  return record;
}

}  // namespace talus
