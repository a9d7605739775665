#include "talus/fit/score/deposit_score.hpp"

#include <algorithm>
#include <cmath>

#include "fitting_values.hpp"
#include "score_rows.hpp"
#include "talus/base/expect.hpp"
#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/fit/score/fair_scores.hpp"
#include "talus/fit/score/holm.hpp"

namespace talus {
namespace {

// Patterns that are ranked for a p-value, the mapped one included: at least, and of each class. The smallest p-value,
// corrected for the number of classes, is then 0.04 at most, and a wrong pattern can be told at 5 %.
constexpr std::size_t kFewestPatterns = 100, kPatternsOfClass = 25;
constexpr std::uint64_t kPatternSeed = 1;
constexpr std::size_t kStopsCompared = 100;  // of each block: more cost time and tell little

using Places = std::vector<Eigen::Vector2d>;

std::size_t class_of(const Campaign& campaign, const MeasuredBlock& block) {
  return class_of(*campaign.deposits, equivalent_diameter(block.mass, block.density));
}

std::vector<double> angles_of(const Campaign& campaign, const Places& places) {
  std::vector<double> angles;
  for (const Eigen::Vector2d& place : places)
    if (const double angle = run_out(campaign, place).angle; !std::isnan(angle)) angles.push_back(angle);
  return angles;
}

double spread_of(const Places& places) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& place : places) {
    x.push_back(place.x());
    y.push_back(place.y());
  }
  return std::sqrt(variance_of(x) + variance_of(y));
}

/// Scores mapped blocks group by group.
class DepositScorer {
 public:
  DepositScorer(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                const ScoreOptions& options)
      : campaign_(campaign), runs_(runs), ask_(ask), options_(options), nothing_simulated_(runs.empty()), rows_(runs) {
    for (std::uint32_t b = 0; b < campaign.blocks.size(); ++b) {
      simulated_.emplace_back();
      if (!runs.empty() && ask[b]) simulated_[b] = stops_of(runs[b]);
    }
  }

  Score result() {
    for (std::size_t number = 0; number <= campaign_.deposits->limits.size(); ++number) places(number);
    angles();
    return rows_.result(ask_);
  }

 private:
  const Places& anywhere(const MeasuredBlock& block) const {
    return campaign_.deposits->anywhere[region_at(*campaign_.deposits, *block.stop)];
  }
  /// Rise of the score of a block that most trials send off the DEM.
  double gone(std::uint32_t b) const {
    return options_.leaving_costs && !nothing_simulated_ ? kGone * most_gone(runs_[b]) : 0.0;
  }
  bool too_few(std::size_t simulated) const { return simulated < options_.fewest_simulated; }

  void places(std::size_t number) {
    Places fitting;
    for (const MeasuredBlock& block : campaign_.blocks)
      if (!block.holdout && class_of(campaign_, block) == number) fitting.push_back(*block.stop);
    if (fitting.size() < kFewestRows) return;
    const double spread = spread_of(fitting);
    if (!(spread > 0.0)) return;
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b) {
      const MeasuredBlock& block = campaign_.blocks[b];
      if (!ask_[b] || class_of(campaign_, block) != number) continue;
      const bool unseen = too_few(simulated_[b].size());
      row(b, fair_energy_score(unseen ? anywhere(block) : simulated_[b], *block.stop) / spread + gone(b), unseen);
    }
    rows_.close(class_name(*campaign_.deposits, number));
  }

  void angles() {
    Places fitting;
    for (const MeasuredBlock& block : campaign_.blocks)
      if (!block.holdout) fitting.push_back(*block.stop);
    const std::vector<double> measured = angles_of(campaign_, fitting);
    if (measured.size() < kFewestRows) return;
    const double spread = std::sqrt(variance_of(measured));
    if (!(spread >= kLeastAngleSpread)) return;
    const bool alone = rows_.empty();  // no class of size has a group
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b) {
      const MeasuredBlock& block = campaign_.blocks[b];
      const double angle = ask_[b] ? run_out(campaign_, *block.stop).angle : kNotGiven;
      if (std::isnan(angle)) continue;
      std::vector<double> values = angles_of(campaign_, simulated_[b]);
      const bool unseen = too_few(values.size());
      if (unseen) values = angles_of(campaign_, anywhere(block));
      row(b, fair_crps(values, angle) / spread + (alone ? gone(b) : 0.0), unseen);
    }
    rows_.close("run-out angle");
  }

  /// @param unseen  whether what might be anywhere stands in for the simulated stops
  void row(std::uint32_t block, double score, bool unseen) { rows_.add(block, score, unseen && !nothing_simulated_); }

  const Campaign& campaign_;
  std::span<const BlockRuns> runs_;
  const std::vector<bool>& ask_;
  const ScoreOptions options_;
  const bool nothing_simulated_;
  std::vector<Places> simulated_;  // by block: its stops in the mapped region
  ScoreRows rows_;
};

/// Sum and number of distances.
struct Mean {
  double sum = 0.0, count = 0.0;
  void add(double value) { sum += value, count += 1.0; }
  double value() const { return sum / count; }
};

/// The blocks of one class that have enough simulated stops.
struct ClassOfBlocks {
  Places mapped;
  std::vector<Places> simulated;       // by block
  std::vector<std::uint32_t> streams;  // by block
};

/// Share of the patterns that are at least as far from their other places as the mapped one is. For a right model the
/// place of a block on the map and its simulated stops are alike, in any order. So each pattern begins these places at
/// a random one, block by block: that is its place, the others are its stops. Rotations are a group, which makes the
/// rank exact for any number of stops. Source: Hemerik & Goeman (2018), "Exact testing with random permutations".
///
/// @param patterns  that are ranked, the mapped one included
double p_value_of(double distance, const ClassOfBlocks& blocks, std::size_t patterns) {
  std::size_t as_far = 1;
  Places mapped = blocks.mapped;
  std::vector<Places> simulated = blocks.simulated;
  for (std::uint32_t pattern = 0; pattern + 1 < patterns; ++pattern) {
    for (std::size_t b = 0; b < mapped.size(); ++b) {
      Places all = blocks.simulated[b];
      all.insert(all.begin(), blocks.mapped[b]);
      const double draw = draw_of_block(kPatternSeed, blocks.streams[b], pattern, BlockDraw::Trial);
      const auto first = static_cast<std::ptrdiff_t>(draw * static_cast<double>(all.size()));
      std::rotate(all.begin(), all.begin() + first, all.end());
      mapped[b] = all.front();
      simulated[b].assign(all.begin() + 1, all.end());
    }
    if (pattern_distance(mapped, simulated).distance >= distance) ++as_far;
  }
  return static_cast<double>(as_far) / static_cast<double>(patterns);
}

/// The blocks of a class among those asked for.
ClassOfBlocks blocks_of(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                        std::size_t number) {
  ClassOfBlocks blocks;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    if (!ask[b] || class_of(campaign, campaign.blocks[b]) != number) continue;
    Places stops = stops_of(runs[b]);
    if (stops.size() < kFewestSimulated) continue;
    stops.resize(std::min(stops.size(), kStopsCompared));
    blocks.mapped.push_back(*campaign.blocks[b].stop);
    blocks.simulated.push_back(std::move(stops));
    blocks.streams.push_back(campaign.blocks[b].stream);
  }
  return blocks;
}

}  // namespace

PatternDistance pattern_distance(std::span<const Eigen::Vector2d> mapped, std::span<const Places> simulated) {
  TALUS_EXPECT(mapped.size() == simulated.size(), "each mapped block has its simulated stops");
  Mean across, within_simulated, within_mapped;
  for (std::size_t i = 0; i < mapped.size(); ++i)
    for (std::size_t k = 0; k < mapped.size(); ++k) {
      if (k == i) continue;
      Mean to, between;
      for (std::size_t t = 0; t < simulated[k].size(); ++t) {
        to.add((mapped[i] - simulated[k][t]).norm());
        if (t < simulated[i].size()) between.add((simulated[i][t] - simulated[k][t]).norm());
      }
      across.add(to.value());
      within_simulated.add(between.value());
      within_mapped.add((mapped[i] - mapped[k]).norm());
    }
  PatternDistance out;
  out.blocks = static_cast<std::uint32_t>(mapped.size());
  if (across.count == 0.0) return out;
  out.distance = 2.0 * across.value() - within_simulated.value() - within_mapped.value();
  out.share = out.distance / (2.0 * across.value());
  return out;
}

Score deposit_score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                    const ScoreOptions& options) {
  TALUS_EXPECT(runs.empty() || runs.size() == campaign.blocks.size(), "each block has its runs");
  return DepositScorer(campaign, runs, ask, options).result();
}

DepositCheck check_deposits(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask) {
  DepositCheck check;
  Mean inside;
  double elsewhere = 0.0;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    if (ask[b]) elsewhere += runs[b].elsewhere;
    for (std::uint32_t t = 0; ask[b] && t < runs[b].trials; ++t) inside.add(std::isnan(runs[b].x[t]) ? 0.0 : 1.0);
  }
  check.inside = inside.value();
  check.mapped = (inside.sum + elsewhere) / inside.count;
  const auto& regions = campaign.deposits->region.values;
  check.whole_dem = std::ranges::count(regions, 0) == 0;
  check.strips = campaign.deposits->anywhere.size() > 2;
  std::vector<ClassOfBlocks> classes;  // those of `patterns`
  for (std::size_t number = 0; number <= campaign.deposits->limits.size(); ++number) {
    ClassOfBlocks blocks = blocks_of(campaign, runs, ask, number);
    if (blocks.mapped.size() < kFewestRows) continue;
    check.patterns.push_back(pattern_distance(blocks.mapped, blocks.simulated));
    check.patterns.back().group = class_name(*campaign.deposits, number);
    classes.push_back(std::move(blocks));
  }
  const std::size_t patterns = std::max(kFewestPatterns, kPatternsOfClass * classes.size());
  for (std::size_t i = 0; i < classes.size(); ++i)
    check.patterns[i].p_value = p_value_of(check.patterns[i].distance, classes[i], patterns);
  correct_rows(check.patterns);
  return check;
}

}  // namespace talus
