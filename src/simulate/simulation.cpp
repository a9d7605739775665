#include "talus/simulate/simulation.hpp"

#include <omp.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>

#include "talus/simulate/plan.hpp"

namespace talus {
namespace {

double thread_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What one unit of work (some blocks of one source) hands to the sinks.
struct Rows {
  std::vector<StopRow> stops;
  std::vector<Crossing> crossings;
  std::vector<RecordedPath> paths;
};

/// Hands the rows of the units to the sinks in the order of the units, whichever worker finished them.
class InOrder {
 public:
  InOrder(const Sinks& sinks, std::uint64_t first) : sinks_(sinks), next_(first) {}

  void finish(std::uint64_t unit, Rows&& rows) {
    const std::lock_guard guard(mutex_);
    if (failed_) return;
    failed_ = true;  // until all is handed out: no sink is called again after it has thrown
    waiting_.emplace(unit, std::move(rows));
    for (auto it = waiting_.begin(); it != waiting_.end() && it->first == next_; it = waiting_.erase(it), ++next_) {
      if (sinks_.stops) sinks_.stops(it->second.stops);
      if (sinks_.crossings && !it->second.crossings.empty()) sinks_.crossings(it->second.crossings);
      if (sinks_.paths)
        for (const RecordedPath& path : it->second.paths) sinks_.paths(path);
    }
    failed_ = false;
  }

 private:
  const Sinks& sinks_;
  std::mutex mutex_;
  std::map<std::uint64_t, Rows> waiting_;
  std::uint64_t next_;
  bool failed_ = false;
};

void add_way(Totals& totals, const Path& path) {
  totals.barriers.add(path);
  totals.impacts += path.impacts;
  totals.psi_dropped += path.psi_dropped;
  totals.length_mm += std::llround(1e3 * path.length);
  totals.plan_length_mm += std::llround(1e3 * path.plan_length);
}

void add(Totals& totals, const Release& release, const Path& path) {
  if (path.end == End::Limit) {
    const std::array<std::uint32_t, 2> id{release.source, release.block};
    if (totals.ends[static_cast<std::size_t>(End::Limit)] == 0 || id < totals.first_limit) totals.first_limit = id;
  }
  totals.ends[static_cast<std::size_t>(path.end)] += 1;
  totals.released += 1;
  add_way(totals, path);
}

}  // namespace

/// One stretch of a simulation: all that the workers share.
class Simulation::Advance {
 public:
  explicit Advance(Simulation& simulation)
      : run_(simulation),
        scenario_(simulation.scenario_),
        order_(simulation.sinks_, simulation.position_.unit),
        next_(simulation.position_.unit),
        done_(simulation.position_.unit) {
    totals_.barriers = BarrierTally(scenario_.barriers);
  }

  /// Takes units until none is left. Nothing may leave an OpenMP region: the first exception is kept.
  void work() noexcept {
    Totals mine;
    mine.barriers = BarrierTally(scenario_.barriers);
    const double start = thread_cpu_seconds();
    try {
      VisitBatch batch(scenario_.surface.grid());
      Path path;
      while (!stop_) {
        const std::uint64_t unit = next_++;  // is done now, so that a pause leaves none out
        if (unit >= run_.units_) break;
        Rows rows = trace_unit(unit, path, batch, mine);
        if (batch.full()) score(batch, mine);
        const double before = thread_cpu_seconds();
        order_.finish(unit, std::move(rows));
        mine.sink_cpu_seconds += thread_cpu_seconds() - before;
        report();
      }
      score(batch, mine);
    } catch (...) {
      const std::lock_guard guard(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
    mine.cpu_seconds = thread_cpu_seconds() - start;
    const std::lock_guard guard(mutex_);
    add(totals_, mine);
  }

  /// All workers are done: what they did becomes the simulation's.
  void finish() {
    if (failure_) std::rethrow_exception(failure_);
    run_.position_.unit = std::min<std::uint64_t>(next_, run_.units_);
    add(run_.totals_, totals_);
    run_.totals_.interrupted = interrupted_;
  }

 private:
  void score(VisitBatch& batch, Totals& totals) {
    totals.cells_scored += run_.tally_.add(batch);
    batch.clear();
  }

  Rows trace_unit(std::uint64_t unit, Path& path, VisitBatch& batch, Totals& totals) {
    const std::uint32_t source = run_.first_source_ + static_cast<std::uint32_t>(unit / run_.units_per_source_);
    const auto first = static_cast<std::uint32_t>(unit % run_.units_per_source_) * kBlocksPerUnit;
    const std::uint32_t count = std::min(scenario_.trajectories - first, kBlocksPerUnit);
    const std::uint32_t round = run_.position_.round, begin = round * scenario_.trajectories + first;
    const World world = scenario_.world();
    const std::shared_ptr<SourceReach> reach = run_.reaches_.of(source);
    Rows rows;
    for (std::uint32_t block = begin; block < begin + count; ++block) {
      const Release release = make_release(scenario_, source, block);
      trace(world, release, path);
      if (const AnnualWeights* weights = run_.tally_.weights())
        batch.set_stake({weights->weight(scenario_, source, block), round * run_.units_ + unit, count});
      batch.add(path, release.body.mass, source, reach);
      add(totals, release, path);
      if (run_.sinks_.walked) run_.sinks_.walked(release, path);
      if (run_.sinks_.stops) rows.stops.push_back(stop_row(release, path));
      if (run_.sinks_.crossings) run_.screens_.find(release, path, rows.crossings);
      if (run_.sinks_.paths && round == 0 && is_recorded(scenario_, source, block))
        rows.paths.push_back({stop_row(release, path), points_of(path, spacing())});
      if (!path.pieces.empty())
        trace_pieces(world, path, [&](const Release& piece, const Path& way) {
          batch.add(way, piece.body.mass, source, reach, true);
          totals.pieces += 1;
          add_way(totals, way);
          if (run_.sinks_.crossings) run_.screens_.find(piece, way, rows.crossings);
        });
    }
    return rows;
  }

  double spacing() const {
    const double asked = run_.sinks_.path_spacing;
    return asked > 0.0 ? asked : scenario_.surface.grid().cell_x;
  }

  /// After every unit: asks whether to go on.
  void report() {
    const std::lock_guard guard(mutex_);
    ++done_;
    if (stop_) return;
    const Sinks& sinks = run_.sinks_;
    try {
      const bool proceed =
          !sinks.progress || sinks.progress(static_cast<double>(done_) / static_cast<double>(run_.units_));
      interrupted_ = !proceed && done_ < run_.units_;
      stop_ = !proceed || (sinks.pause && sinks.pause());
    } catch (...) {
      stop_ = true;  // before the lock is released: it is not called again
      throw;
    }
  }

  Simulation& run_;
  const Scenario& scenario_;
  InOrder order_;
  std::atomic<std::uint64_t> next_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards what follows
  std::uint64_t done_;
  Totals totals_;
  std::exception_ptr failure_;
  bool interrupted_ = false;
};

std::shared_ptr<SourceReach> Reaches::of(std::uint32_t source) {
  if (units_ == 1 && !keep_) return nullptr;
  const std::lock_guard guard(mutex_);
  const auto it = open_.try_emplace(source).first;
  if (!it->second.reach) it->second.reach = std::make_shared<SourceReach>();
  std::shared_ptr<SourceReach> reach = it->second.reach;
  if (++it->second.asked == units_ && !keep_) open_.erase(it);
  return reach;
}

void Reaches::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(open_.size()));
  for (const auto& [source, entry] : open_) {
    out.put(source);
    out.put(entry.asked);
    entry.reach->save(out);
  }
}

void Reaches::restore(ByteReader& in) {
  const auto count = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    Entry& entry = open_[in.get<std::uint32_t>()];
    entry.asked = in.get<std::uint32_t>();
    entry.reach = std::make_shared<SourceReach>();
    entry.reach->restore(in);
  }
}

Simulation::Simulation(const Scenario& scenario, const Part& part, bool further_rounds, Tally& tally,
                       const Sinks& sinks)
    : scenario_(scenario),
      tally_(tally),
      sinks_(sinks),
      screens_(scenario),
      first_source_(part.first(scenario.sources.size())),
      units_per_source_((scenario.trajectories + kBlocksPerUnit - 1) / kBlocksPerUnit),
      units_(std::uint64_t{units_per_source_} * (part.end(scenario.sources.size()) - first_source_)),
      reaches_(units_per_source_, further_rounds) {
  totals_.barriers = BarrierTally(scenario.barriers);
}

void Simulation::advance(int threads) {
  Advance work(*this);
#pragma omp parallel num_threads(threads > 0 ? threads : omp_get_num_procs()) default(none) shared(work)
  work.work();
  work.finish();
}

void Simulation::restore(const Position& position, const Totals& totals, ByteReader& reaches) {
  position_ = position;
  totals_ = totals;
  reaches_.restore(reaches);
}

}  // namespace talus
