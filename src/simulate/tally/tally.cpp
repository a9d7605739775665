#include "talus/simulate/tally/tally.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tally_region.hpp"

namespace talus {
namespace {

std::int64_t fixed_point(float value, double units) {
  return static_cast<std::int64_t>(static_cast<double>(value) * units + 0.5);
}

/// The largest float at or below each: a float exceeds a threshold just where it exceeds that.
std::vector<float> floats_below(const std::vector<double>& thresholds) {
  std::vector<float> limits;
  for (const double threshold : thresholds) {
    const auto nearest = static_cast<float>(threshold);
    limits.push_back(nearest > threshold ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest);
  }
  return limits;
}

std::uint32_t exceeding(std::span<const float> values, float limit) {
  std::uint32_t count = 0;
#pragma omp simd reduction(+ : count)
  for (std::size_t i = 0; i < values.size(); ++i) count += values[i] > limit ? 1U : 0U;
  return count;
}

std::size_t cell_in_region(int column, int row) {
  return static_cast<std::size_t>(row % kRegionSide * kRegionSide + column % kRegionSide);
}

/// Counting sort: visits by cell, those of one cell in their order before.
std::vector<Visit> sorted_by_cell(const std::vector<Visit>& visits) {
  std::array<std::uint32_t, kRegionCells + 1> start{};
  for (const Visit& visit : visits) ++start[visit.cell + 1U];
  for (std::size_t cell = 0; cell < kRegionCells; ++cell) start[cell + 1] += start[cell];
  std::vector<Visit> sorted(visits.size());
  for (const Visit& visit : visits) sorted[start[visit.cell]++] = visit;
  return sorted;
}

/// The visits of a batch to one cell.
struct Group {
  const Visit *begin, *end;
  std::size_t record;
};

/// Asks the processor for memory that is needed soon: records lie anywhere, and waiting for them would rule the cost.
void fetch(const void* memory, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(static_cast<const char*>(memory) + i, 1);
}

/// The cells of a region that the source of a trajectory has reached in other batches too.
class ReachOf {
 public:
  ReachOf(const VisitBatch& batch, std::size_t region) : batch_(batch), region_(region) {}

  /// Whether the source reaches the cell for the first time; it counts as reached from then on. Trajectories of one
  /// source follow each other, so that within a group a source's first trajectory decides.
  bool first(std::uint16_t trajectory, std::size_t cell) {
    const VisitBatch::Trajectory& t = batch_.trajectories()[trajectory];
    if (!t.reach) return true;
    if (t.reach.get() != reach_) {
      reach_ = t.reach.get();
      cells_ = &reach_->cells(region_);
    }
    if ((*cells_)[cell]) return false;
    return (*cells_)[cell] = true;
  }

 private:
  const VisitBatch& batch_;
  std::size_t region_;
  SourceReach* reach_ = nullptr;
  SourceReach::Cells* cells_ = nullptr;
};

/// Whether two trajectories of a batch, `first` before `second`, are what one block became.
bool of_one_block(const VisitBatch& batch, std::uint16_t first, std::uint16_t second) {
  const auto& all = batch.trajectories();
  return std::all_of(&all[first] + 1, &all[second] + 1, [](const VisitBatch::Trajectory& t) { return t.piece; });
}

/// Makes one value of each trajectory's visits, its largest, and adds the counts of the group to the record.
void gather(const Group& group, const VisitBatch& batch, Tally::Values& values, CellRecord& record, ReachOf& reach) {
  values.make_room(static_cast<std::size_t>(group.end - group.begin));
  std::size_t n = 0;
  std::uint32_t source = 0;
  std::uint16_t previous = 0;  // the trajectory of the last value
  bool rests = false;          // it, or a piece of it, has come to rest here
  for (const Visit* visit = group.begin; visit != group.end;) {
    const std::uint16_t trajectory = visit->trajectory;
    float speed_squared = 0.0F, height = 0.0F;
    std::uint32_t deposits = 0;
    for (; visit != group.end && visit->trajectory == trajectory; ++visit) {
      speed_squared = std::max(speed_squared, visit->speed_squared);
      height = std::max(height, visit->height);
      record.impacts += visit->impacts;
      deposits += visit->deposited;
    }
    const VisitBatch::Trajectory& of = batch.trajectories()[trajectory];
    const auto energy = static_cast<float>(0.5e-3 * of.mass * speed_squared);
    if (of.piece && n > 0 && of_one_block(batch, previous, trajectory)) {  // one value of all that a block became
      record.deposits += rests ? 0U : deposits;
      rests = rests || deposits > 0;
      values.lists[0][n - 1] = std::max(values.lists[0][n - 1], energy);
      values.lists[1][n - 1] = std::max(values.lists[1][n - 1], std::sqrt(speed_squared));
      values.lists[2][n - 1] = std::max(values.lists[2][n - 1], height);
      continue;
    }
    previous = trajectory;
    record.deposits += deposits;
    rests = deposits > 0;
    if (n == 0 || of.source != source) {
      source = of.source;
      record.sources += reach.first(trajectory, group.begin->cell) ? 1U : 0U;
    }
    if (values.keep_stakes) values.stakes[n] = of.stake;
    values.lists[0][n] = energy;
    values.lists[1][n] = std::sqrt(speed_squared);
    values.lists[2][n++] = height;
  }
  values.count = n;
}

}  // namespace

void Tally::EndRegions::operator()(Region* regions) const noexcept {
  if (memory.has_limit()) return;
  std::destroy_n(regions, count);
  memory.release(regions, count * sizeof(Region));
}

Tally::Tally(const Grid& grid, std::vector<double> energy_thresholds, std::vector<double> height_thresholds,
             MemoryPolicy memory)
    : grid_(grid),
      energy_thresholds_(std::move(energy_thresholds)),
      height_thresholds_(std::move(height_thresholds)),
      energy_limits_(floats_below(energy_thresholds_)),
      height_limits_(floats_below(height_thresholds_)),
      regions_across_((grid.columns + kRegionSide - 1) / kRegionSide),
      region_count_(static_cast<std::size_t>(regions_across_) *
                    static_cast<std::size_t>((grid.rows + kRegionSide - 1) / kRegionSide)),
      regions_(static_cast<Region*>(memory.allocate(region_count_ * sizeof(Region))), {memory, 0}) {
  for (std::size_t& made = regions_.get_deleter().count; made < region_count_; ++made)
    std::construct_at(&regions_[made], memory);
}

void Tally::keep_hazard(AnnualWeights weights) {
  hazard_ = std::make_unique<Hazard>(Hazard{{EnergyBins(energy_thresholds_), weights.scale()}, std::move(weights)});
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
  std::vector<std::size_t> busy;  // regions that another worker holds: taken last
  for (const auto& [index, visits] : batch.regions()) {
    if (visits.empty()) continue;
    const std::unique_lock lock(regions_[index].mutex, std::try_to_lock);
    if (lock.owns_lock())
      scored += score(index, visits, batch);
    else
      busy.push_back(index);
  }
  for (const std::size_t index : busy) {
    const std::unique_lock lock(regions_[index].mutex);
    scored += score(index, batch.regions().at(index), batch);
  }
  return scored;
}

std::uint64_t Tally::score(std::size_t index, const std::vector<Visit>& visits, const VisitBatch& batch) {
  memory().keep_below_limit();
  Region& region = regions_[index];
  const std::vector<Visit> sorted = sorted_by_cell(visits);
  std::vector<Group> groups;
  for (std::size_t i = 0; i < sorted.size();) {
    const std::size_t first = i, cell = sorted[i].cell;
    while (i < sorted.size() && sorted[i].cell == cell) ++i;
    groups.push_back({&sorted[first], &sorted[first] + (i - first), region.record_of(cell, thresholds())});
  }
  std::uint64_t scored = 0;
  ReachOf reach(batch, index);
  Values values;
  values.keep_stakes = hazard_ != nullptr;
  if (hazard_) region.make_hazards();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i + 16 < groups.size()) fetch(&region.records[groups[i + 16].record], sizeof(CellRecord));
    if (i + 8 < groups.size())
      for (const LogHistogram& h : region.records[groups[i + 8].record].histogram) fetch(h.counts(), 128);
    CellRecord& record = region.records[groups[i].record];
    gather(groups[i], batch, values, record, reach);
    add(record, region.exceedances.data() + groups[i].record * thresholds(), values);
    if (hazard_) region.hazards[groups[i].record].add(hazard_->rules, values.of(0), values.stakes);
    scored += values.count;
  }
  return scored;
}

void Tally::add(CellRecord& record, std::uint32_t* over, const Values& values) const {
  record.passages += static_cast<std::uint32_t>(values.count);
  std::array<float, kQuantities> largest{};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    std::int64_t sum = 0;
    float most = 0.0F;
#pragma omp simd reduction(+ : sum) reduction(max : most)
    for (std::size_t i = 0; i < values.count; ++i) {
      sum += fixed_point(values.lists[q][i], 1.0 / kFixedPoint[q]);
      most = std::max(most, values.lists[q][i]);
    }
    record.sum[q] += sum;
    largest[q] = most;
    record.maximum[q] = std::max(record.maximum[q], largest[q]);
    record.histogram[q].add(values.of(q));
  }
  const auto count_over = [&](const std::vector<float>& limits, Quantity of) {
    const auto q = static_cast<std::size_t>(of);
    for (std::size_t i = 0; i < limits.size() && largest[q] > limits[i]; ++i)  // ascending: the rest is not exceeded
      over[i] += exceeding(values.of(q), limits[i]);
    over += limits.size();
  };
  count_over(energy_limits_, Quantity::Energy);
  count_over(height_limits_, Quantity::Height);
}

const Tally::Region& Tally::region_of(int column, int row) const {
  return regions_[static_cast<std::size_t>(row / kRegionSide) * static_cast<std::size_t>(regions_across_) +
                  static_cast<std::size_t>(column / kRegionSide)];
}

const CellRecord* Tally::find(int column, int row) const {
  const Region& region = region_of(column, row);
  if (region.slot.empty()) return nullptr;
  const std::uint16_t slot = region.slot[cell_in_region(column, row)];
  return slot == 0 ? nullptr : &region.records[slot - 1U];
}

const HazardCell* Tally::hazard(int column, int row) const {
  const Region& region = region_of(column, row);
  if (!hazard_ || region.slot.empty()) return nullptr;
  const std::uint16_t slot = region.slot[cell_in_region(column, row)];
  return slot == 0 ? nullptr : &region.hazards[slot - 1U];
}

const std::uint32_t* Tally::exceedances(int column, int row) const {
  const Region& region = region_of(column, row);
  return region.exceedances.data() + (region.slot[cell_in_region(column, row)] - 1U) * thresholds();
}

}  // namespace talus
