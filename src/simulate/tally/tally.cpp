#include "talus/simulate/tally/tally.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "passages.hpp"
#include "tally_region.hpp"
#include "talus/base/expect.hpp"
#include "talus/simulate/tally/checked_sum.hpp"

namespace talus {
namespace {

/// The largest float at or below each threshold: a float exceeds the threshold if and only if it exceeds this float.
std::vector<float> floats_below(const std::vector<double>& thresholds) {
  std::vector<float> limits;
  for (const double threshold : thresholds) {
    const auto nearest = static_cast<float>(threshold);
    limits.push_back(nearest > threshold ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest);
  }
  return limits;
}

PerQuantity<std::vector<float>> floats_below(const Thresholds& thresholds) {
  PerQuantity<std::vector<float>> limits;
  for (std::size_t q = 0; q < kQuantities; ++q) limits[q] = floats_below(thresholds[q]);
  return limits;
}

std::uint32_t exceeding(std::span<const float> values, float limit) {
  std::uint32_t count = 0;
#pragma omp simd reduction(+ : count)
  for (std::size_t i = 0; i < values.size(); ++i) count += values[i] > limit ? 1U : 0U;
  return count;
}

std::int64_t fixed_length(double length) {
  return fixed_point(length, 1.0 / CellRecord::kLengthUnit);
}

/// Empties a container and releases its memory, which an assignment of `{}` would keep.
template <class Container>
void give_back(Container& container) {
  Container(container.get_allocator()).swap(container);
}

/// By cell of a region, where its visits begin when they are sorted by cell.
std::array<std::uint32_t, kRegionCells + 1> starts_of_cells(const VisitList& visits) {
  std::array<std::uint32_t, kRegionCells + 1> start{};
  visits.for_each([&](const Visit& visit) { ++start[visit.cell + 1U]; });
  for (std::size_t cell = 0; cell < kRegionCells; ++cell) start[cell + 1] += start[cell];
  return start;
}

/// Prefetches memory that is needed soon: records are scattered, and waiting for them would take most of the time.
void prefetch(const void* memory, std::size_t bytes) {
  if (memory == nullptr || bytes == 0) return;  // a histogram that has no counts yet
  const char* const begin = static_cast<const char*>(memory);
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(begin + i, 1);
  __builtin_prefetch(begin + bytes - 1, 1);  // the end may lie in one line more
}

/// Sums of whole lengths by the number of energy thresholds that they are above: one addition for each length.
class LengthsByLevel {
 public:
  explicit LengthsByLevel(std::size_t levels) : levels_(levels) { std::fill_n(sums_.begin(), levels, 0); }
  void add(std::size_t level, std::int64_t length) { sums_[level] += length; }
  /// Adds the lengths above each threshold. Returns the sum of all.
  std::int64_t add_to(std::int64_t* above) {
    for (std::size_t level = levels_ - 1; level > 0; --level) {
      above[level - 1] += sums_[level];
      sums_[level - 1] += sums_[level];
    }
    return sums_[0];
  }

 private:
  std::array<std::int64_t, 64> sums_;
  std::size_t levels_;
};

/// The lengths of a visit [m]: all counted parts, then those above each threshold, as far as there are some.
std::span<const float> lengths_of(const Visit& visit, std::span<const float> mixed, std::size_t levels,
                                  std::array<float, 64>& buffer) {
  if (visit.mixed) return mixed.subspan(std::bit_cast<std::uint32_t>(visit.length), levels);
  const std::size_t count = 1U + visit.above;
  for (std::size_t i = 0; i < count; ++i) buffer[i] = visit.length;
  return {buffer.data(), count};
}

}  // namespace

/// The visits of a batch to one cell.
struct Tally::Group {
  std::span<const Visit> visits;
  std::size_t record;
};

/// Buffers for the visits of one region. The regions of a batch use them in turn, so that memory is allocated once.
struct Tally::Work {
  std::vector<Visit> sorted;  // by cell; those of one cell keep their order
  std::vector<float> totals;  // of the sorted visits
  std::vector<Group> groups;
  CellValues values;

  void sort(const RegionVisits& region) {
    auto start = starts_of_cells(region.visits);
    if (sorted.size() < region.visits.size()) sorted.resize(region.visits.size());
    totals.resize(region.totals.size());
    auto total = region.totals.begin();
    region.visits.for_each([&](const Visit& visit) {
      const std::uint32_t place = start[visit.cell]++;
      sorted[place] = visit;
      if (!totals.empty()) totals[place] = *total++;
    });
  }
};

void Tally::EndRegions::operator()(Region* regions) const noexcept {
  if (memory.has_limit()) return;
  std::destroy_n(regions, count);
  memory.release(regions, count * sizeof(Region));
}

Tally::Tally(const Grid& grid, std::vector<double> energy_thresholds, std::vector<double> height_thresholds,
             MemoryPolicy memory)
    : grid_(grid),
      thresholds_(thresholds_of(std::move(energy_thresholds), std::move(height_thresholds))),
      limits_(floats_below(thresholds_)),
      threshold_count_(std::accumulate(thresholds_.begin(), thresholds_.end(), std::size_t{0},
                                       [](std::size_t sum, const auto& of) { return sum + of.size(); })),
      layout_(grid),
      regions_(static_cast<Region*>(memory.allocate(layout_.count() * sizeof(Region))), {memory, 0}) {
  for (std::size_t& made = regions_.get_deleter().count; made < layout_.count(); ++made)
    std::construct_at(&regions_[made], memory);
}

void Tally::keep_hazard(AnnualWeights weights) {
  hazard_ = std::make_unique<Hazard>(
      Hazard{{EnergyBins(thresholds_[Quantity::Energy]), weights.scale(), count_rotation_}, std::move(weights)});
}

void Tally::count_rotation() {
  keep_total_ = count_rotation_ = true;
  if (hazard_) hazard_->rules.with_rotation = true;
}

void Tally::set_rounds(std::uint32_t rounds) {
  if (!hazard_) return;
  WeightScale& scale = hazard_->rules.scale;
  scale.unit /= rounds;
  scale.square_unit /= static_cast<double>(rounds) * rounds;
  scale.trajectories *= rounds;
}

Tally::~Tally() = default;
Tally::Tally(Tally&&) noexcept = default;

std::uint64_t Tally::add(const VisitBatch& batch) {
  std::uint64_t scored = 0;
  Work work;
  std::vector<std::size_t> busy;  // regions that another worker holds: taken last
  for (const auto& [index, visits] : batch.regions()) {
    if (visits.visits.empty()) continue;
    const std::unique_lock lock(regions_[index].mutex, std::try_to_lock);
    if (lock.owns_lock())
      scored += score(index, visits, batch, work);
    else
      busy.push_back(index);
  }
  for (const std::size_t index : busy) {
    const std::unique_lock lock(regions_[index].mutex);
    scored += score(index, batch.regions().at(index), batch, work);
  }
  return scored;
}

std::uint64_t Tally::score(std::size_t index, const RegionVisits& visits, const VisitBatch& batch, Work& work) {
  memory().keep_below_limit();
  TALUS_EXPECT(index < layout_.count(), "a visit lies in a region of the tally");
  Region& region = regions_[index];
  TALUS_EXPECT(batch.levels() <= 1 + energy_thresholds(), "a batch has no other thresholds than the tally");
  TALUS_EXPECT(batch.counts_rotation() == count_rotation_, "a batch counts the same energy as the tally");
  TALUS_EXPECT(visits.totals.size() == (keep_total_ ? visits.visits.size() : 0), "each visit has its total energy");
  prefetch(visits.lengths.data(), visits.lengths.size() * sizeof(float));
  work.sort(visits);
  const std::span<const Visit> all = std::span(work.sorted).first(visits.visits.size());
  std::vector<Group>& groups = work.groups;
  groups.clear();
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t first = i, cell = all[i].cell;
    while (i < all.size() && all[i].cell == cell) ++i;
    groups.push_back({all.subspan(first, i - first), region.record_of(cell, threshold_count_, energy_thresholds())});
  }
  TALUS_EXPECT(region.records.size() <= kRegionCells, "a cell has one record");
  std::uint64_t scored = 0;
  ReachOf reach(batch, index);
  CellValues& values = work.values;
  values.keep_annual_shares = hazard_ != nullptr;
  values.keep_totals = keep_total_;
  if (hazard_) region.make_hazards();
  if (keep_total_) region.make_totals();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i + 16 < groups.size()) prefetch(&region.records[groups[i + 16].record], sizeof(CellRecord));
    if (i + 8 < groups.size()) {
      const std::size_t soon = groups[i + 8].record;
      for (const LogHistogram& h : region.records[soon].histogram) prefetch(h.counts(), h.bytes());
      prefetch(region.exceedances.data() + soon * threshold_count_, sizeof(std::uint32_t) * threshold_count_);
      prefetch(region.lengths.data() + soon * energy_thresholds(), sizeof(std::int64_t) * energy_thresholds());
      if (hazard_) prefetch(region.hazards[soon].lengths().data(), region.hazards[soon].lengths().size_bytes());
      if (keep_total_) prefetch(region.totals[soon].histogram.counts(), region.totals[soon].histogram.bytes());
    }
    CellRecord& record = region.records[groups[i].record];
    gather(groups[i].visits, batch, values, record, reach);
    PerQuantity<float> largest = record.add(values);
    if (keep_total_) {
      const auto first = static_cast<std::size_t>(groups[i].visits.data() - all.data());
      gather_totals(groups[i].visits, std::span(work.totals).subspan(first), batch, values.totals);
      const float total = region.totals[groups[i].record].add({values.totals.data(), values.count});
      if (count_rotation_) largest[Quantity::Energy] = total;
    }
    count_exceedances(region.exceedances.data() + groups[i].record * threshold_count_, values, largest);
    add_lengths(groups[i], visits.lengths, batch, region);
    if (hazard_) {
      HazardCell& hazard = region.hazards[groups[i].record];
      hazard.add(hazard_->rules, counted(Quantity::Energy, values), values.annual_shares);
      add_weighted_lengths(groups[i], visits.lengths, batch, hazard);
    }
    scored += values.count;
  }
  return scored;
}

/// Adds the lengths of all visits. Squares are of the whole length of a block: its visits and pieces are not
/// independent.
void Tally::add_lengths(const Group& group, std::span<const float> mixed, const VisitBatch& batch,
                        Region& region) const {
  CellRecord& record = region.records[group.record];
  std::int64_t* const above = region.lengths.data() + group.record * energy_thresholds();
  LengthsByLevel whole(batch.levels());
  std::uint16_t previous = group.visits.front().trajectory;
  double of_block = 0.0;
  std::int64_t length = 0, squares = 0;
  for (const Visit& visit : group.visits) {
    if (visit.trajectory != previous && !(batch.has_pieces() && of_one_block(batch, previous, visit.trajectory))) {
      squares += fixed_length(of_block * of_block);
      of_block = 0.0;
    }
    previous = visit.trajectory;
    if (!visit.mixed) {
      of_block += visit.length;
      whole.add(visit.above, fixed_length(visit.length));
      continue;
    }
    const float* const lengths = mixed.data() + std::bit_cast<std::uint32_t>(visit.length);
    of_block += lengths[0];
    length += fixed_length(lengths[0]);
    for (std::size_t i = 0; i + 1 < batch.levels(); ++i) above[i] += fixed_length(lengths[1 + i]);
  }
  add_checked(record.length, length + whole.add_to(above));
  add_checked(record.length_squares, squares + fixed_length(of_block * of_block));
}

/// Adds the weighted lengths of all visits to the hazard of the cell.
void Tally::add_weighted_lengths(const Group& group, std::span<const float> mixed, const VisitBatch& batch,
                                 HazardCell& hazard) const {
  std::array<float, 64> buffer;
  for (const Visit& visit : group.visits) {
    const VisitBatch::Trajectory& of = batch.trajectories()[visit.trajectory];
    hazard.add_lengths(hazard_->rules, lengths_of(visit, mixed, batch.levels(), buffer), of.annual_share,
                       of.size.diameter);
  }
}

/// The values of which exceedances and hazard count: of the energies those with rotation, if these are counted.
std::span<const float> Tally::counted(Quantity quantity, const CellValues& values) const {
  if (count_rotation_ && quantity == Quantity::Energy) return {values.totals.data(), values.count};
  return values.of(quantity);
}

/// @param largest  of the counted values of each quantity
void Tally::count_exceedances(std::uint32_t* over, const CellValues& values, const PerQuantity<float>& largest) const {
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const std::vector<float>& limits = limits_[q];
    const std::span<const float> all = counted(static_cast<Quantity>(q), values);
    for (std::size_t i = 0; i < limits.size() && largest[q] > limits[i]; ++i)  // ascending: the rest is not exceeded
      over[i] += exceeding(all, limits[i]);
    over += limits.size();
  }
}

Tally::Place Tally::place_of(int column, int row) const {
  const Region& region = regions_[layout_.of_cell(column, row)];
  const std::uint16_t slot = region.slot.empty() ? std::uint16_t{0} : region.slot[cell_in_region(column, row)];
  return {region, slot == 0 ? kNoRecord : slot - std::size_t{1}};
}

const CellRecord* Tally::find(int column, int row) const {
  const auto [region, record] = place_of(column, row);
  return record == kNoRecord ? nullptr : &region.records[record];
}

void Tally::prefetch_record(int column, int row) const {
  if (const CellRecord* const record = find(column, row)) prefetch(record, sizeof(CellRecord));
}

const HazardCell* Tally::hazard(int column, int row) const {
  if (!hazard_) return nullptr;
  const auto [region, record] = place_of(column, row);
  return record == kNoRecord ? nullptr : &region.hazards[record];
}

const EnergyTotal* Tally::energy_total(int column, int row) const {
  if (!keep_total_) return nullptr;
  const auto [region, record] = place_of(column, row);
  return &region.totals[record];
}

const std::uint32_t* Tally::exceedances(int column, int row) const {
  const auto [region, record] = place_of(column, row);
  return region.exceedances.data() + record * threshold_count_;
}

const std::int64_t* Tally::lengths_above(int column, int row) const {
  const auto [region, record] = place_of(column, row);
  return region.lengths.data() + record * energy_thresholds();
}

bool Tally::is_touched(std::size_t region) const {
  return !regions_[region].slot.empty();
}

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
    for (std::size_t i = 0; i < threshold_count_; ++i) out.put(region.exceedances[record * threshold_count_ + i]);
    for (std::size_t i = 0; i < energy_thresholds(); ++i) out.put(region.lengths[record * energy_thresholds() + i]);
    if (keep_total_) region.totals[record].save(out);
    if (hazard_) region.hazards[record].save(out);
  }
}

void Tally::take(std::size_t index, ByteWriter& out) {
  save(index, out);
  Region& region = regions_[index];
  give_back(region.slot), give_back(region.exceedances), give_back(region.lengths);
  give_back(region.records), give_back(region.totals), give_back(region.hazards);
}

void Tally::merge(std::size_t index, ByteReader& in) {
  memory().keep_below_limit();
  Region& region = regions_[index];
  while (!in.empty()) {
    const auto cell = in.get<std::uint16_t>();
    if (cell >= kRegionCells) throw std::out_of_range("a cell of the tally");
    const std::size_t record = region.record_of(cell, threshold_count_, energy_thresholds());
    region.records[record].merge(CellRecord::restored(in));
    for (std::size_t i = 0; i < threshold_count_; ++i)
      add_checked(region.exceedances[record * threshold_count_ + i], in.get<std::uint32_t>());
    for (std::size_t i = 0; i < energy_thresholds(); ++i)
      add_checked(region.lengths[record * energy_thresholds() + i], in.get<std::int64_t>());
    if (keep_total_) {
      region.make_totals();
      region.totals[record].merge(EnergyTotal::restored(in));
    }
    if (!hazard_) continue;
    region.make_hazards();
    region.hazards[record].merge(HazardCell::restored(hazard_->rules, in));
  }
}

std::vector<std::uint64_t> Tally::cells_by_passages(std::uint32_t most) const {
  std::vector<std::uint64_t> cells(most + 1U);
  for (std::size_t i = 0; i < regions(); ++i)
    for (const CellRecord& record : regions_[i].records) ++cells[std::min(record.passages, most)];
  return cells;
}

std::uint64_t Tally::touched_cells() const {
  return std::accumulate(&regions_[0], &regions_[0] + regions(), std::uint64_t{0},
                         [](std::uint64_t sum, const Region& region) { return sum + region.records.size(); });
}

}  // namespace talus
