#include "talus/simulate/simulation.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <mutex>
#include <numeric>

#include "base/in_threads.hpp"
#include "rows_in_order.hpp"
#include "talus/base/expect.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/plan/work_order.hpp"
#include "talus/simulate/plan/work_units.hpp"

namespace talus {
namespace {

double thread_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Most units of a chunk if several processes share the work: small chunks keep the wait at the end short.
constexpr std::uint64_t kUnitsPerChunk = 32;

void add_way(Totals& totals, const Path& path) {
  totals.barriers.add(path);
  totals.impacts += path.impacts;
  totals.psi_dropped += path.psi_dropped;
  totals.length_mm += std::llround(1e3 * path.length);
  totals.plan_length_mm += std::llround(1e3 * path.plan_length);
}

/// Counts a block that ended at a limit, or of which a piece did.
void add_limited(Totals& totals, const Release& release) {
  const std::array<std::uint32_t, 2> id{release.source, release.block};
  if (totals.limited_blocks == 0 || id < totals.first_limit) totals.first_limit = id;
  totals.limited_blocks += 1;
}

void add(Totals& totals, const Path& path) {
  totals.ends[static_cast<std::size_t>(path.end)] += 1;
  totals.released += 1;
  add_way(totals, path);
}

}  // namespace

/// One call of `advance`: the state that its workers share.
class Simulation::Advance {
 public:
  Advance(Simulation& simulation, int lanes)
      : run_(simulation),
        lanes_(lanes),
        scenario_(simulation.scenario_),
        rows_in_order_(simulation.sinks_),
        work_units_(simulation.processes_, {simulation.position_.unit, simulation.unit_count_}, simulation.chunk_,
                    simulation.further_rounds_) {
    totals_.barriers = BarrierTally(scenario_.barriers);
  }

  /// Takes units until none is left.
  void work();
  /// Makes the workers leave what is left.
  void stop() { failed_ = true; }

  /// Called when all workers are done. True: all units of the process group are done. False: there are more to take.
  bool all_done() {
    if (!work_units_.agree_on_end()) return false;
    run_.position_.unit = work_units_.end();
    add(run_.totals_, totals_);
    run_.totals_.interrupted = interrupted_;
    TALUS_EXPECT(std::accumulate(totals_.ends.begin(), totals_.ends.end(), std::uint64_t{0}) == totals_.released,
                 "each trajectory ended once");
    return true;
  }

 private:
  /// A unit of work of which some blocks are not done.
  struct Unit {
    std::uint64_t number;             // as WorkUnits::Taken
    std::uint32_t source, next, end;  // next block to be released, block after the last
    std::uint32_t left;               // blocks that are not done
    std::uint32_t count;              // blocks
    std::shared_ptr<SourceReach> reach;
    UnitRows rows;
  };
  class Worker;

  double spacing() const {
    const double asked = run_.sinks_.path_spacing;
    return asked > 0.0 ? asked : scenario_.surface.grid().cell_x;
  }

  /// After every unit: asks whether to go on.
  void report() {
    const std::lock_guard guard(mutex_);
    ++done_;
    if (stopped_) return;
    const Sinks& sinks = run_.sinks_;
    try {
      const bool proceed = !sinks.progress || sinks.progress(share_done());
      interrupted_ = !proceed && !(share_done() >= 1.0);
      stopped_ = !proceed || (sinks.pause && sinks.pause());
    } catch (...) {
      stopped_ = true;  // before the lock is released: no sink is called again
      throw;
    }
    if (stopped_) work_units_.stop();
  }

  /// Share of the work done. Assumes that all processes of a group are equally fast.
  double share_done() const {
    const double done = static_cast<double>(done_) * run_.processes_.size() + static_cast<double>(run_.position_.unit);
    return std::min(1.0, done / static_cast<double>(run_.unit_count_));
  }

  Simulation& run_;
  int lanes_;
  const Scenario& scenario_;
  RowsInOrder rows_in_order_;
  WorkUnits work_units_;
  std::atomic<bool> failed_{false};
  std::mutex mutex_;  // guards the members below
  std::uint64_t done_ = 0;
  Totals totals_;
  bool stopped_ = false, interrupted_ = false;
};

/// The work of one thread: takes units, traces their blocks and scores the paths. The units that it traces at the same
/// time lie in `open_units_`; paths come in the order in which the blocks were released.
class Simulation::Advance::Worker {
 public:
  Worker(Advance& work, Totals& totals)
      : work_(work),
        run_(work.run_),
        scenario_(work.scenario_),
        totals_(totals),
        world_(scenario_.world()),
        tracer_(world_, work.lanes_),
        batch_(scenario_.surface.grid(), length_rules(scenario_.output)) {
    if (run_.tally_.keeps_energy_total()) batch_.keep_energy_total();
  }

  void work() {
    while (!all_taken_ && !work_.failed_) {
      tracer_.run([this](Release& release, std::uint64_t&) { return next(release); },
                  [this](const Release& release, const Path& path, std::uint64_t) { done(release, path); });
      totals_.cells_scored += run_.tally_.add(batch_);
      batch_.clear();
    }
  }

 private:
  /// The next block: of the unit taken last, or of another. No unit is taken while the batch is full: the batch holds
  /// all paths of its units.
  bool next(Release& release) {
    if (open_units_.empty() || open_units_.back().next == open_units_.back().end)
      if (work_.failed_ || batch_.full() || !take()) return false;
    Unit& unit = open_units_.back();
    release = make_release(scenario_, unit.source, unit.next++);
    return true;
  }

  bool take() {
    const std::optional<WorkUnits::Taken> taken =
        work_.work_units_.next();  // always completed: a pause leaves none out
    all_taken_ = !taken;
    if (!taken) return false;
    const std::uint32_t place = run_.first_place_ + static_cast<std::uint32_t>(taken->unit / run_.units_per_source_);
    const UnitBlocks blocks =
        blocks_of_unit(scenario_, static_cast<std::uint32_t>(taken->unit % run_.units_per_source_));
    const std::uint32_t count = blocks.end - blocks.first;
    const std::uint32_t begin = run_.position_.round * scenario_.trajectories + blocks.first;
    open_units_.push_back(
        {taken->number, run_.order_[place], begin, begin + count, count, count, run_.reaches_.of(place), {}});
    open_units_.back().rows.unit = taken->unit;
    return true;
  }

  void done(const Release& release, const Path& path) {
    Unit& unit = open_units_.front();
    const std::uint32_t round = run_.position_.round;
    std::int64_t weight = 0;
    if (const AnnualWeights* weights = run_.tally_.weights()) {
      weight = weights->weight(scenario_, unit.source, release.block);
      batch_.set_annual_share({weight, round * run_.unit_count_ + unit.rows.unit, unit.count});
    }
    batch_.add(path, release.body, unit.source, unit.reach);
    add(totals_, path);
    if (run_.sinks_.walked) run_.sinks_.walked(release, path);
    if (run_.sinks_.stops) unit.rows.stops.push_back(stop_row(release, path));
    if (run_.sinks_.crossings) run_.screens_.find(release, path, unit.rows.crossings);
    if (run_.sinks_.paths && round == 0 && is_recorded(scenario_, unit.source, release.block))
      unit.rows.paths.push_back({stop_row(release, path), points_of(path, work_.spacing())});
    const PieceEnds pieces = add_pieces(unit, path);
    if (pieces.left || path.end == End::Left) {
      totals_.left_blocks += 1;
      totals_.left_weight += weight;
    }
    if (pieces.limited || path.end == End::Limit) add_limited(totals_, release);
    if (--unit.left == 0) close(unit);
  }

  /// Whether one of the pieces of a block left the terrain, and whether one ended at a limit.
  struct PieceEnds {
    bool left = false, limited = false;
  };

  /// Traces and scores the pieces that broke off a block.
  PieceEnds add_pieces(Unit& unit, const Path& whole) {
    PieceEnds ends;
    if (!whole.pieces.empty())
      trace_pieces(world_, whole, [&](const Release& piece, const Path& path) {
        add_piece(unit, piece, path);
        ends.left = ends.left || path.end == End::Left;
        ends.limited = ends.limited || path.end == End::Limit;
      });
    return ends;
  }

  void add_piece(Unit& unit, const Release& piece, const Path& path) {
    batch_.add(path, piece.body, unit.source, unit.reach, true);
    totals_.pieces += 1;
    add_way(totals_, path);
    if (run_.sinks_.crossings) run_.screens_.find(piece, path, unit.rows.crossings);
  }

  void close(Unit& unit) {
    const double before = thread_cpu_seconds();
    work_.rows_in_order_.hand_in(unit.number, std::move(unit.rows));
    totals_.sink_cpu_seconds += thread_cpu_seconds() - before;
    open_units_.pop_front();
    work_.report();
  }

  Advance& work_;
  Simulation& run_;
  const Scenario& scenario_;
  Totals& totals_;
  const World world_;
  Tracer tracer_;
  VisitBatch batch_;
  std::deque<Unit> open_units_;
  bool all_taken_ = false;
};

void Simulation::Advance::work() {
  Totals mine;
  mine.barriers = BarrierTally(scenario_.barriers);
  const double start = thread_cpu_seconds();
  Worker(*this, mine).work();
  mine.cpu_seconds = thread_cpu_seconds() - start;
  const std::lock_guard guard(mutex_);
  add(totals_, mine);
}

Simulation::Simulation(const Scenario& scenario, const Part& part, bool further_rounds, Tally& tally,
                       const Sinks& sinks, ProcessGroup& processes)
    : scenario_(scenario),
      tally_(tally),
      sinks_(sinks),
      processes_(processes),
      screens_(scenario),
      order_(work_order(scenario.surface.grid(), scenario.sources)),
      first_place_(part.first(scenario.sources.size())),
      units_per_source_(units_per_source(scenario)),
      unit_count_(std::uint64_t{units_per_source_} * (part.end(scenario.sources.size()) - first_place_)),
      chunk_(1),
      further_rounds_(further_rounds),
      reaches_(units_per_source_, further_rounds, tally.memory()) {
  totals_.barriers = BarrierTally(scenario.barriers);
  if (processes.size() == 1) return;
  const std::uint64_t fair = unit_count_ / (64U * static_cast<std::uint64_t>(processes.size()));
  const std::uint64_t sources = std::min(fair, kUnitsPerChunk) / units_per_source_;  // whole ones, per chunk
  chunk_ = std::max<std::uint64_t>(1, sources) * units_per_source_;
}

void Simulation::advance(int threads, int lanes) {
  Advance work(*this, lanes);
  do
    in_threads(
        threads, [&] { work.work(); }, [&] { work.stop(); });
  while (!work.all_done());
}

void Simulation::save_reaches(const std::function<void(std::string_view)>& put) const {
  // Otherwise chunks hold whole source cells, and each chunk that was begun is done: there is nothing to save.
  if (processes_.size() == 1 || further_rounds_) reaches_.save(put);
}

void Simulation::restore(const Position& position, const Totals& totals) {
  position_ = position;
  totals_ = totals;
}

void Simulation::restore_reach(ByteReader& piece) {
  reaches_.restore(piece, [this](std::uint32_t place) {
    const std::uint64_t unit = std::uint64_t{place - first_place_} * units_per_source_;
    return !further_rounds_ || WorkUnits::owns(processes_, unit, chunk_);
  });
}

}  // namespace talus
