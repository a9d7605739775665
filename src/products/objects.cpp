#include "talus/products/objects.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>

#include "base/in_threads.hpp"
#include "object_finder.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/plan/work_units.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/totals.hpp"

namespace talus {
namespace {

/// The state that the workers share.
class Replay {
 public:
  Replay(const Scenario& scenario, const AnnualWeights& weights, std::span<const HazardObject> objects,
         const std::function<bool(double)>& proceed)
      : scenario_(scenario),
        weights_(weights),
        rules_{EnergyBins(scenario.output.energy_thresholds), weights.scale(), scenario.output.count_rotation},
        finder_(scenario.surface, scenario.barriers, objects, 0.5 * diameters_of(scenario).high,
                scenario.output.count_rotation),
        proceed_(proceed),
        per_source_(units_per_source(scenario)),
        units_(std::uint64_t{per_source_} * scenario.sources.size()),
        hits_(objects.size()) {}

  void work();
  void stop() { stop_ = true; }

  std::vector<ObjectHits> result() {
    if (ended_) return {};
    return std::move(hits_);
  }

 private:
  class Worker;

  void report() {
    const std::lock_guard guard(mutex_);
    ++done_;
    if (!proceed_ || stop_ || proceed_(static_cast<double>(done_) / static_cast<double>(units_))) return;
    ended_ = stop_ = true;
  }

  const Scenario& scenario_;
  const AnnualWeights& weights_;
  HazardRules rules_;
  ObjectFinder finder_;
  const std::function<bool(double)>& proceed_;
  std::uint32_t per_source_;
  std::uint64_t units_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards the members below
  std::vector<ObjectHits> hits_;
  std::uint64_t done_ = 0;
  bool ended_ = false;
};

/// The work of one thread: takes units and traces their blocks. The units that it traces at the same time lie in
/// `open_units_`; paths come in the order in which the blocks were released.
class Replay::Worker {
 public:
  explicit Worker(Replay& replay)
      : replay_(replay),
        scenario_(replay.scenario_),
        world_(scenario_.world()),
        tracer_(world_),
        here_(replay.hits_.size()),
        hits_(replay.hits_.size()) {}

  std::vector<ObjectHits> work() {
    tracer_.run([this](Release& release, std::uint64_t&) { return next(release); },
                [this](const Release& release, const Path& path, std::uint64_t) { done(release, path); });
    return std::move(hits_);
  }

 private:
  struct Unit {
    std::uint64_t number;
    std::uint32_t source, next, end, count, left;         // left: blocks that are not done
    std::vector<std::vector<float>> largest, entry;       // by object
    std::vector<std::vector<AnnualShare>> annual_shares;  // likewise
  };

  bool next(Release& release) {
    if (replay_.stop_ || ((open_units_.empty() || open_units_.back().next == open_units_.back().end) && !take()))
      return false;
    Unit& unit = open_units_.back();
    release = make_release(scenario_, unit.source, unit.next++);
    return true;
  }

  bool take() {
    const std::uint64_t number = replay_.next_++;
    if (number >= replay_.units_) return false;
    const auto [first, end] = blocks_of_unit(scenario_, static_cast<std::uint32_t>(number % replay_.per_source_));
    const std::size_t objects = hits_.size();
    open_units_.push_back({number, static_cast<std::uint32_t>(number / replay_.per_source_), first, end, end - first,
                           end - first, std::vector<std::vector<float>>(objects),
                           std::vector<std::vector<float>>(objects), std::vector<std::vector<AnnualShare>>(objects)});
    return true;
  }

  void done(const Release& release, const Path& path) {
    Unit& unit = open_units_.front();
    find_contacts(release, path);
    for (std::size_t i = 0; i < here_.size(); ++i) {
      if (here_[i].largest < 0.0F) continue;
      unit.largest[i].push_back(here_[i].largest);
      unit.entry[i].push_back(here_[i].entry);
      unit.annual_shares[i].push_back(
          {replay_.weights_.weight(scenario_, unit.source, release.block), unit.number, unit.count});
    }
    if (--unit.left > 0) return;
    close(unit);
    open_units_.pop_front();
    replay_.report();
  }

  /// Finds the contacts of a block with each object; those of its pieces, too.
  void find_contacts(const Release& release, const Path& path) {
    std::ranges::fill(here_, ObjectContact{});
    replay_.finder_.add(path, release.body, here_);
    if (path.pieces.empty()) return;
    trace_pieces(world_, path, [&](const Release& piece, const Path& way) {
      std::vector<ObjectContact> of_piece(here_.size());
      replay_.finder_.add(way, piece.body, of_piece);
      for (std::size_t i = 0; i < here_.size(); ++i) here_[i].raise(of_piece[i]);
    });
  }

  void close(Unit& unit) {
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      hits_[i].largest.add(replay_.rules_, unit.largest[i], unit.annual_shares[i]);
      hits_[i].entry.add(replay_.rules_, unit.entry[i], unit.annual_shares[i]);
      hits_[i].trajectories += unit.largest[i].size();
      for (const AnnualShare& annual_share : unit.annual_shares[i])
        if (annual_share.weight > 0) hits_[i].by_feature[scenario_.sources[unit.source].feature] += annual_share.weight;
    }
  }

  Replay& replay_;
  const Scenario& scenario_;
  const World world_;
  Tracer tracer_;
  std::deque<Unit> open_units_;
  std::vector<ObjectContact> here_;  // by object, of the block that is done
  std::vector<ObjectHits> hits_;     // likewise, of all units that are done
};

void Replay::work() {
  const std::vector<ObjectHits> mine = Worker(*this).work();
  const std::lock_guard guard(mutex_);
  for (std::size_t i = 0; i < hits_.size(); ++i) hits_[i].merge(mine[i]);
}

}  // namespace

void ObjectHits::merge(const ObjectHits& other) {
  largest.merge(other.largest);
  entry.merge(other.entry);
  for (const auto& [feature, weight] : other.by_feature) by_feature[feature] += weight;
  trajectories += other.trajectories;
}

std::vector<ObjectHits> replay_objects(const Scenario& scenario, const AnnualWeights& weights,
                                       std::span<const HazardObject> objects,
                                       const std::function<bool(double)>& proceed, int threads) {
  Replay replay(scenario, weights, objects, proceed);
  in_threads(
      threads, [&] { replay.work(); }, [&] { replay.stop(); });
  return replay.result();
}

}  // namespace talus
