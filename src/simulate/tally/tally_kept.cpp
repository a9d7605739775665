// What a tally tells of its regions as a whole: bytes for files and other processes, numbers of cells.
#include <algorithm>
#include <numeric>

#include "tally_region.hpp"

namespace talus {

void Tally::save(std::size_t index, ByteWriter& out) const {
  memory().keep_below_limit();
  const Region& region = regions_[index];
  if (region.slot.empty()) return;
  for (std::size_t cell = 0; cell < kRegionCells; ++cell) {
    const std::uint16_t slot = region.slot[cell];
    if (slot == 0) continue;
    const std::size_t record = slot - 1U;
    out.put(static_cast<std::uint16_t>(cell));
    region.records[record].save(out);
    for (std::size_t i = 0; i < thresholds(); ++i) out.put(region.exceedances[record * thresholds() + i]);
    if (hazard_) region.hazards[record].save(out);
  }
}

void Tally::take(std::size_t index, ByteWriter& out) {
  save(index, out);
  Region& region = regions_[index];
  region.slot = {}, region.exceedances = {};
  region.records.clear(), region.hazards.clear();
}

void Tally::merge(std::size_t index, ByteReader& in) {
  memory().keep_below_limit();
  Region& region = regions_[index];
  while (!in.empty()) {
    const auto cell = in.get<std::uint16_t>();
    if (cell >= kRegionCells) throw std::out_of_range("a cell of the tally");
    const std::size_t record = region.record_of(cell, thresholds());
    region.records[record].merge(CellRecord::restored(in));
    for (std::size_t i = 0; i < thresholds(); ++i)
      region.exceedances[record * thresholds() + i] += in.get<std::uint32_t>();
    if (!hazard_) continue;
    region.make_hazards();
    region.hazards[record].merge(HazardCell::restored(in));
  }
}

std::vector<std::uint64_t> Tally::cells_by_passages(std::uint32_t most) const {
  std::vector<std::uint64_t> cells(most + 1U);
  for (std::size_t i = 0; i < region_count_; ++i)
    for (const CellRecord& record : regions_[i].records) ++cells[std::min(record.passages, most)];
  return cells;
}

std::uint64_t Tally::touched_cells() const {
  return std::accumulate(&regions_[0], &regions_[0] + region_count_, std::uint64_t{0},
                         [](std::uint64_t sum, const Region& region) { return sum + region.records.size(); });
}

}  // namespace talus
