#include "talus/simulate/simulate.hpp"

#include <omp.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>

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

StopRow stop_row(const Release& release, const Path& path) {
  const Motion& end = path.vertices.back().motion;
  double fastest = 0.0;
  for (const Span& span : path.spans)
    fastest = std::max<double>(
        fastest, span.plan_speed_squared + std::max(span.rise_from * span.rise_from, span.rise_to * span.rise_to));
  StopRow row{};
  row.source = release.source;
  row.block = release.block;
  row.end = path.end;
  row.diameter = static_cast<float>(path.breaks.empty() ? release.body.diameter : path.breaks.back().body.diameter);
  row.mass = static_cast<float>(path.mass);
  row.x_release = static_cast<float>(release.motion.position.x());
  row.y_release = static_cast<float>(release.motion.position.y());
  row.x = end.position.x();
  row.y = end.position.y();
  row.z = end.position.z();
  row.seconds = static_cast<float>(end.time);
  row.max_speed = static_cast<float>(std::sqrt(fastest));
  row.length = static_cast<float>(path.length);
  row.plan_length = static_cast<float>(path.plan_length);
  row.impacts = path.impacts;
  return row;
}

/// Hands the rows of the units to the sinks in the order of the units, whichever worker finished them.
class InOrder {
 public:
  explicit InOrder(const Sinks& sinks) : sinks_(sinks) {}

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
  std::uint64_t next_ = 0;
  bool failed_ = false;
};

/// The reach of each source that several units share, held until the last of them has asked for it.
class Reaches {
 public:
  explicit Reaches(std::uint32_t units_per_source) : units_per_source_(units_per_source) {}

  /// Once per unit. Empty where one unit holds the whole source: it sees all that the source reaches.
  std::shared_ptr<SourceReach> of(std::uint32_t source) {
    if (units_per_source_ == 1) return nullptr;
    const std::lock_guard guard(mutex_);
    const auto it = open_.try_emplace(source).first;
    if (!it->second.reach) it->second.reach = std::make_shared<SourceReach>();
    std::shared_ptr<SourceReach> reach = it->second.reach;
    if (++it->second.asked == units_per_source_) open_.erase(it);
    return reach;
  }

 private:
  struct Entry {
    std::shared_ptr<SourceReach> reach;
    std::uint32_t asked = 0;
  };
  std::uint32_t units_per_source_;
  std::mutex mutex_;
  std::map<std::uint32_t, Entry> open_;
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

void add(Totals& totals, const Totals& part) {
  constexpr auto kLimit = static_cast<std::size_t>(End::Limit);
  if (part.ends[kLimit] > 0 && (totals.ends[kLimit] == 0 || part.first_limit < totals.first_limit))
    totals.first_limit = part.first_limit;
  for (std::size_t e = 0; e < kEnds; ++e) totals.ends[e] += part.ends[e];
  totals.released += part.released;
  totals.pieces += part.pieces;
  totals.impacts += part.impacts;
  totals.psi_dropped += part.psi_dropped;
  totals.cells_scored += part.cells_scored;
  totals.length_mm += part.length_mm;
  totals.plan_length_mm += part.plan_length_mm;
  totals.barriers.merge(part.barriers);
  totals.sink_cpu_seconds += part.sink_cpu_seconds;
  totals.cpu_seconds += part.cpu_seconds;
}

/// The whole run as units of work: all that the workers share.
class Run {
 public:
  Run(const Scenario& scenario, Tally& tally, const Sinks& sinks)
      : scenario_(scenario),
        tally_(tally),
        sinks_(sinks),
        screens_(scenario),
        units_per_source_((scenario.trajectories + kBlocksPerUnit - 1) / kBlocksPerUnit),
        units_(std::uint64_t{units_per_source_} * scenario.sources.size()),
        order_(sinks),
        reaches_(units_per_source_) {
    totals_.barriers = BarrierTally(scenario.barriers);
  }

  /// Takes units until none is left. Nothing may leave an OpenMP region: the first exception is kept.
  void work() noexcept {
    Totals mine;
    mine.barriers = BarrierTally(scenario_.barriers);
    const double start = thread_cpu_seconds();
    try {
      VisitBatch batch(scenario_.surface.grid());
      Path path;
      for (std::uint64_t unit = next_++; unit < units_ && !stop_; unit = next_++) {
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

  Totals result() {
    if (failure_) std::rethrow_exception(failure_);
    totals_.interrupted = interrupted_;
    return totals_;
  }

 private:
  void score(VisitBatch& batch, Totals& totals) {
    totals.cells_scored += tally_.add(batch);
    batch.clear();
  }

  Rows trace_unit(std::uint64_t unit, Path& path, VisitBatch& batch, Totals& totals) {
    const auto source = static_cast<std::uint32_t>(unit / units_per_source_);
    const auto first = static_cast<std::uint32_t>(unit % units_per_source_) * kBlocksPerUnit;
    const std::uint32_t end = std::min(scenario_.trajectories, first + kBlocksPerUnit);
    const World world = scenario_.world();
    const std::shared_ptr<SourceReach> reach = reaches_.of(source);
    Rows rows;
    for (std::uint32_t block = first; block < end; ++block) {
      const Release release = make_release(scenario_, source, block);
      trace(world, release, path);
      if (const AnnualWeights* weights = tally_.weights())
        batch.set_stake({weights->weight(scenario_, source, block), unit, end - first});
      batch.add(path, release.body.mass, source, reach);
      add(totals, release, path);
      if (sinks_.walked) sinks_.walked(release, path);
      if (sinks_.stops) rows.stops.push_back(stop_row(release, path));
      if (sinks_.crossings) screens_.find(release, path, rows.crossings);
      if (sinks_.paths && is_recorded(scenario_, source, block))
        rows.paths.push_back({stop_row(release, path), points_of(path, spacing())});
      if (!path.pieces.empty())
        trace_pieces(world, path, [&](const Release& piece, const Path& way) {
          batch.add(way, piece.body.mass, source, reach, true);
          totals.pieces += 1;
          add_way(totals, way);
          if (sinks_.crossings) screens_.find(piece, way, rows.crossings);
        });
    }
    return rows;
  }

  double spacing() const { return sinks_.path_spacing > 0.0 ? sinks_.path_spacing : scenario_.surface.grid().cell_x; }

  void report() {
    const std::lock_guard guard(mutex_);
    ++done_;
    if (!sinks_.progress || stop_) return;
    try {
      if (sinks_.progress(static_cast<double>(done_) / static_cast<double>(units_))) return;
    } catch (...) {
      stop_ = true;  // before the lock is released: it is not called again
      throw;
    }
    interrupted_ = done_ < units_;
    stop_ = true;
  }

  const Scenario& scenario_;
  Tally& tally_;
  const Sinks& sinks_;
  ScreenFinder screens_;
  std::uint32_t units_per_source_;
  std::uint64_t units_;
  InOrder order_;
  Reaches reaches_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards what follows
  std::uint64_t done_ = 0;
  Totals totals_;
  std::exception_ptr failure_;
  bool interrupted_ = false;
};

}  // namespace

std::vector<PathPoint> points_of(const Path& path, double spacing) {
  std::vector<PathPoint> points;
  const auto push = [&points](const Vec3& p, double time) { points.push_back({p.x(), p.y(), p.z(), time}); };
  for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
    const Motion &from = path.vertices[i].motion, &to = path.vertices[i + 1].motion;
    push(from.position, from.time);
    if (path.vertices[i].event == Event::Slide) continue;
    const double plan = (to.position - from.position).head<2>().norm();
    const int pieces = static_cast<int>(std::ceil(plan / spacing));
    for (int k = 1; k < pieces; ++k) {
      const double t = (to.time - from.time) * k / pieces;
      Vec3 p = from.position + t * from.velocity;
      p.z() -= 0.5 * kGravity * t * t;
      push(p, from.time + t);
    }
  }
  push(path.vertices.back().motion.position, path.vertices.back().motion.time);
  return points;
}

Totals simulate(const Scenario& scenario, Tally& tally, const Sinks& sinks, int threads) {
  Run run(scenario, tally, sinks);
#pragma omp parallel num_threads(threads > 0 ? threads : omp_get_num_procs()) default(none) shared(run)
  run.work();
  return run.result();
}

}  // namespace talus
