#include "talus/products/objects.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "base/in_threads.hpp"
#include "object_finder.hpp"
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
        rules_{EnergyBins(scenario.output.energy_thresholds), weights.scale()},
        finder_(scenario.surface, scenario.barriers, objects, 0.5 * diameters_of(scenario).high),
        proceed_(proceed),
        per_source_(units_per_source(scenario)),
        units_(std::uint64_t{per_source_} * scenario.sources.size()),
        hits_(objects.size()) {}

  void work() {
    std::vector<ObjectHits> mine(hits_.size());
    for (std::uint64_t unit = next_++; unit < units_ && !stop_; unit = next_++) {
      trace_unit(unit, mine);
      report();
    }
    const std::lock_guard guard(mutex_);
    for (std::size_t i = 0; i < hits_.size(); ++i) hits_[i].merge(mine[i]);
  }

  void stop() { stop_ = true; }

  std::vector<ObjectHits> result() {
    if (ended_) return {};
    return std::move(hits_);
  }

 private:
  /// What one block meets at each object.
  void contacts_of(const Release& release, Path& path, std::vector<ObjectContact>& contacts) const {
    std::ranges::fill(contacts, ObjectContact{});
    const World world = scenario_.world();
    trace(world, release, path);
    finder_.add(path, release.body, contacts);
    if (path.pieces.empty()) return;
    trace_pieces(world, path, [&](const Release& piece, const Path& way) {
      std::vector<ObjectContact> of_piece(contacts.size());
      finder_.add(way, piece.body, of_piece);
      for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].raise(of_piece[i]);
    });
  }

  void trace_unit(std::uint64_t unit, std::vector<ObjectHits>& hits) const {
    const auto source = static_cast<std::uint32_t>(unit / per_source_);
    const auto [first, end] = blocks_of_unit(scenario_, static_cast<std::uint32_t>(unit % per_source_));
    std::vector<std::vector<float>> largest(hits.size()), entry(hits.size());
    std::vector<std::vector<AnnualShare>> annual_shares(hits.size());
    std::vector<ObjectContact> here(hits.size());
    Path path;
    for (std::uint32_t block = first; block < end; ++block) {
      contacts_of(make_release(scenario_, source, block), path, here);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        if (here[i].largest < 0.0F) continue;
        largest[i].push_back(here[i].largest);
        entry[i].push_back(here[i].entry);
        annual_shares[i].push_back({weights_.weight(scenario_, source, block), unit, end - first});
      }
    }
    for (std::size_t i = 0; i < hits.size(); ++i) {
      hits[i].largest.add(rules_, largest[i], annual_shares[i]);
      hits[i].entry.add(rules_, entry[i], annual_shares[i]);
      hits[i].trajectories += largest[i].size();
      for (const AnnualShare& annual_share : annual_shares[i])
        if (annual_share.weight > 0) hits[i].by_feature[scenario_.sources[source].feature] += annual_share.weight;
    }
  }

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
