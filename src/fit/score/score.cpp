#include "talus/fit/score/score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "fitting_values.hpp"
#include "robust_density.hpp"
#include "score_rows.hpp"
#include "talus/base/expect.hpp"
#include "talus/fit/score/deposit_score.hpp"
#include "talus/fit/score/fair_scores.hpp"

namespace talus {
namespace {

constexpr double kHalfWeight = 10.0;  // rows with which a group counts half in a fit

/// Sum over the rows of a block, on average over the blocks.
double mean_of_blocks(const Score& score) {
  std::vector<std::uint32_t> blocks;
  double sum = 0.0;
  for (const RowScore& row : score.rows) sum += row.score, blocks.push_back(row.block);
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks.empty() ? kNotGiven : sum / static_cast<double>(blocks.size());
}

/// Scores the rows of one campaign group by group.
class Scorer {
 public:
  Scorer(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
         const ScoreOptions& options)
      : campaign_(campaign), runs_(runs), ask_(ask), climatology_(runs.empty()), options_(options), rows_(runs) {}

  Score result() {
    TALUS_EXPECT(climatology_ || runs_.size() == campaign_.blocks.size(), "each block has its runs");
    TALUS_EXPECT(ask_.size() == campaign_.blocks.size(), "each block is asked for or not");
    TALUS_EXPECT(options_.folds.empty() || options_.folds.size() == campaign_.blocks.size(), "each block has a fold");
    stops();
    masses();
    for (std::size_t screen = 0; screen < campaign_.screens.size(); ++screen) passages(screen);
    samples("sample speed", &Sample::speed, &BlockRuns::AtSample::speed);
    samples("sample spin", &Sample::spin, &BlockRuns::AtSample::spin);
    Score score = rows_.result(ask_);
    if (options_.rule == ScoreRule::LogDensity) score.total = mean_of_blocks(score);
    return score;
  }

 private:
  template <class Visit>
  void for_asked(Visit visit) const {
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b)
      if (ask_[b]) visit(b, campaign_.blocks[b]);
  }

  void stops() {
    FittingValues<Eigen::Vector2d> fitting, ways;
    std::vector<double> x, y;
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b) {
      const MeasuredBlock& block = campaign_.blocks[b];
      if (block.holdout || !block.stop) continue;
      fitting.add(b, *block.stop);
      ways.add(b, *block.stop - Eigen::Vector2d(block.x, block.y));
      x.push_back(block.stop->x());
      y.push_back(block.stop->y());
    }
    if (fitting.size() < 2) return;
    const double spread = std::sqrt(variance_of(x) + variance_of(y));
    if (!(spread > 0.0)) return;
    std::vector<Eigen::Vector2d> places, broad;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      if (!block.stop) return;
      fitting.of_others(b, broad, options_.folds);
      if (climatology_ && options_.ways_from_release) {
        ways.of_others(b, places, options_.folds);
        for (Eigen::Vector2d& place : places) place += Eigen::Vector2d(block.x, block.y);
      } else if (climatology_) {
        places = broad;
      } else {
        places = stops_of(runs_[b]);
      }
      const bool unseen = too_few(places.size());
      if (unseen) places = own_values_too() ? fitting.values : broad;
      const double score = options_.rule == ScoreRule::Fair ? fair_energy_score(places, *block.stop) / spread
                                                            : -log_density(places, broad, *block.stop, spread);
      rows_.add(b, score + (options_.leaving_costs && !climatology_ ? kGone * most_gone(runs_[b]) : 0.0), unseen);
    });
    rows_.close("stop");
  }

  /// Scores masses only where blocks broke: at least five changed their mass by more than a twentieth.
  void masses() {
    const auto share = [](const MeasuredBlock& b) { return b.stop_mass ? *b.stop_mass / b.mass : kNotGiven; };
    std::size_t changed = 0;  // of the fitting and the asked rows: others must not decide what is fitted
    for (std::size_t b = 0; b < campaign_.blocks.size(); ++b)
      if ((ask_[b] || !campaign_.blocks[b].holdout) && std::abs(share(campaign_.blocks[b]) - 1.0) > 0.05) ++changed;
    if (changed < kFewestRows) return;
    one_value(
        "mass", share, [this](std::uint32_t b) -> const std::vector<double>& { return runs_[b].mass_share; }, 2);
  }

  void passages(std::size_t screen) {
    const auto crossed = [screen](const MeasuredBlock& b) { return b.passages[screen].has_value(); };
    if (std::none_of(campaign_.blocks.begin(), campaign_.blocks.end(), crossed)) return;
    const std::string id = " " + campaign_.screens[screen].id;
    crossings("crossed" + id, screen);
    const auto value = [&](const char* name, double Passage::*measured,
                           std::vector<double> BlockRuns::AtScreen::*runs) {
      one_value(
          name + id, [=](const MeasuredBlock& b) { return crossed(b) ? *b.passages[screen].*measured : kNotGiven; },
          [=, this](std::uint32_t b) -> const std::vector<double>& { return runs_[b].screens[screen].*runs; },
          kFewestRows);
    };
    value("speed", &Passage::speed, &BlockRuns::AtScreen::speed);
    value("jump", &Passage::jump, &BlockRuns::AtScreen::jump);
    value("spin", &Passage::spin, &BlockRuns::AtScreen::spin);
  }

  /// Fair Brier score of the share of trials that crossed, over p (1 - p) of the fitting rows.
  void crossings(const std::string& name, std::size_t screen) {
    const auto crossed = [screen](const MeasuredBlock& b) { return b.passages[screen].has_value(); };
    double fitting = 0.0, hits = 0.0;
    std::size_t asked = 0, asked_hits = 0;
    for (std::size_t b = 0; b < campaign_.blocks.size(); ++b) {
      const bool hit = crossed(campaign_.blocks[b]);
      if (!campaign_.blocks[b].holdout) fitting += 1.0, hits += hit ? 1.0 : 0.0;
      if (ask_[b]) ++asked, asked_hits += hit ? 1 : 0;
    }
    const double p = hits / fitting, spread = p * (1.0 - p);
    if (!(spread > 0.0) || std::min(asked_hits, asked - asked_hits) < kFewestRows) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      const bool hit = crossed(block);
      double others = 0.0, their_hits = 0.0;
      for (std::uint32_t other = 0; other < campaign_.blocks.size(); ++other)
        if (!campaign_.blocks[other].holdout && !together(b, other))
          others += 1.0, their_hits += crossed(campaign_.blocks[other]) ? 1.0 : 0.0;
      const double broad = others > 0.0 ? their_hits / others : p;
      if (!climatology_) keep_finite(runs_[b].screens[screen].speed, values_);
      const double simulated_hits = climatology_ ? their_hits : static_cast<double>(values_.size());
      const double trials = climatology_ ? others : runs_[b].trials;
      rows_.add(b, options_.rule == ScoreRule::Fair ? fair_brier_score(simulated_hits, trials, hit) / spread
                                                    : -log_probability(simulated_hits, trials, broad, hit));
    });
    rows_.close(name);
  }

  /// A group of one number per block.
  void one_value(const std::string& name, const std::function<double(const MeasuredBlock&)>& measured,
                 const std::function<const std::vector<double>&(std::uint32_t)>& simulated, std::size_t fewest) {
    FittingValues<double> fitting;
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b)
      if (!campaign_.blocks[b].holdout && !std::isnan(measured(campaign_.blocks[b])))
        fitting.add(b, measured(campaign_.blocks[b]));
    if (fitting.size() < fewest) return;
    const double spread = std::sqrt(variance_of(fitting.values));
    if (!(spread > 0.0)) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      const double y = measured(block);
      if (std::isnan(y)) return;
      bool unseen = false;
      const double score =
          of_value(b, climatology_ ? kNoValues : simulated(b), fitting, y, spread, unseen) / unit_of(spread);
      rows_.add(b, score, unseen);
    });
    rows_.close(name);
  }

  /// States along the path: several of a block, which counts once, with their mean.
  void samples(const char* name, double Sample::*measured, std::vector<double> BlockRuns::AtSample::*simulated) {
    FittingValues<double> fitting;
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b)
      for (const Sample& sample : campaign_.blocks[b].samples)
        if (!campaign_.blocks[b].holdout && !std::isnan(sample.*measured)) fitting.add(b, sample.*measured);
    if (fitting.size() < kFewestRows) return;
    const double spread = std::sqrt(variance_of(fitting.values));
    if (!(spread > 0.0)) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      double sum = 0.0;
      int count = 0, not_seen = 0;
      for (std::size_t i = 0; i < block.samples.size(); ++i) {
        if (std::isnan(block.samples[i].*measured)) continue;
        bool unseen = false;
        sum += of_value(b, climatology_ ? kNoValues : runs_[b].samples[i].*simulated, fitting,
                        block.samples[i].*measured, spread, unseen);
        ++count;
        not_seen += unseen ? 1 : 0;
      }
      if (count > 0) rows_.add(b, sum / count / unit_of(spread), not_seen == count);
    });
    rows_.close(name);
  }

  /// Score of the simulated values or, where they are too few, of the values of the fitting rows.
  double of_value(std::uint32_t block, const std::vector<double>& simulated, const FittingValues<double>& fitting,
                  double measured, double spread, bool& unseen) {
    fitting.of_others(block, broad_, options_.folds);
    if (climatology_)
      values_ = broad_;
    else
      keep_finite(simulated, values_);
    unseen = too_few(values_.size());
    if (unseen) values_ = own_values_too() ? fitting.values : broad_;
    if (options_.rule == ScoreRule::LogDensity) return -log_density(values_, broad_, measured, spread);
    return fair_crps(values_, measured);
  }

  /// What a score is divided by; a log density has no unit.
  double unit_of(double spread) const { return options_.rule == ScoreRule::Fair ? spread : 1.0; }

  /// Whether two blocks are left out together.
  bool together(std::uint32_t a, std::uint32_t b) const {
    return options_.folds.empty() ? a == b : options_.folds[a] == options_.folds[b];
  }
  /// Out of its fold, and by log density, a row never knows its own value.
  bool own_values_too() const {
    return options_.own_value_too && options_.folds.empty() && options_.rule == ScoreRule::Fair;
  }
  bool too_few(std::size_t simulated) const { return !climatology_ && simulated < options_.fewest_simulated; }

  static inline const std::vector<double> kNoValues{};
  const Campaign& campaign_;
  std::span<const BlockRuns> runs_;
  const std::vector<bool>& ask_;
  const bool climatology_;  // not the runs are scored, but the measurements of the other fitting rows
  const ScoreOptions options_;
  ScoreRows rows_;
  std::vector<double> values_, broad_;
};

}  // namespace

Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            const ScoreOptions& options) {
  if (campaign.deposits != nullptr) return deposit_score(campaign, runs, ask, options);
  return Scorer(campaign, runs, ask, options).result();
}

Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            std::size_t fewest_simulated) {
  ScoreOptions options;
  options.fewest_simulated = fewest_simulated;
  return score(campaign, runs, ask, options);
}

Score score_of_climatology(const Campaign& campaign, const std::vector<bool>& ask, const ScoreOptions& options) {
  return score(campaign, {}, ask, options);
}

Score of_large_groups(const Score& score, std::uint32_t fewest) {
  Score large;
  std::vector<std::uint32_t> number(score.groups.size(), 0);  // of each group among those that are left
  for (std::size_t g = 0; g < score.groups.size(); ++g) {
    const GroupScore& group = score.groups[g];
    if (group.rows < fewest) continue;
    number[g] = static_cast<std::uint32_t>(large.groups.size());
    large.groups.push_back(group);
  }
  for (RowScore row : score.rows) {
    if (score.groups[row.group].rows < fewest) continue;
    row.group = number[row.group];
    large.rows.push_back(row);
  }
  large.total = mean_over(large.groups);
  return large;
}

Score weigh_groups(Score score) {
  for (GroupScore& group : score.groups) group.weight = group.rows / (group.rows + kHalfWeight);
  score.total = mean_over(score.groups);
  return score;
}

std::size_t fewest_simulated_of(std::uint32_t trials) {
  return std::clamp<std::size_t>((trials + 9) / 10, 2, kFewestSimulated);
}

}  // namespace talus
