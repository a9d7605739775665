#include "talus/fit/score/score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr double kHalfWeight = 10.0;  // rows with which a group counts half in a fit

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Variance of the values themselves (n, not n - 1).
double variance_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size());
}

void keep_finite(std::span<const double> values, std::vector<double>& out) {
  out.clear();
  for (const double value : values)
    if (!std::isnan(value)) out.push_back(value);
}

/// Scores the rows of one campaign group by group.
class Scorer {
 public:
  Scorer(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
         std::size_t fewest_simulated)
      : campaign_(campaign), runs_(runs), ask_(ask), fewest_simulated_(fewest_simulated) {}

  Score result() {
    TALUS_EXPECT(runs_.size() == campaign_.blocks.size() && ask_.size() == runs_.size(), "each block has its runs");
    stops();
    masses();
    for (std::size_t screen = 0; screen < campaign_.screens.size(); ++screen) passages(screen);
    samples("sample speed", &Sample::speed, &BlockRuns::AtSample::speed);
    samples("sample spin", &Sample::spin, &BlockRuns::AtSample::spin);
    double sum = 0.0;
    for (const GroupScore& group : score_.groups) sum += group.score;
    if (!score_.groups.empty()) score_.total = sum / static_cast<double>(score_.groups.size());
    return std::move(score_);
  }

 private:
  template <class Visit>
  void for_asked(Visit visit) const {
    for (std::uint32_t b = 0; b < campaign_.blocks.size(); ++b)
      if (ask_[b]) visit(b, campaign_.blocks[b]);
  }

  void row(std::uint32_t block, double score, bool unseen = false) {
    rows_.push_back({static_cast<std::uint32_t>(score_.groups.size()), block, score, unseen});
  }

  void close(const std::string& name) {
    if (rows_.size() >= kFewestRows) {
      double sum = 0.0;
      for (const RowScore& r : rows_) sum += r.score;
      score_.groups.push_back(
          {name, sum / static_cast<double>(rows_.size()), static_cast<std::uint32_t>(rows_.size())});
      score_.groups.back().unseen = static_cast<std::uint32_t>(std::ranges::count(rows_, true, &RowScore::unseen));
      score_.rows.insert(score_.rows.end(), rows_.begin(), rows_.end());
    }
    rows_.clear();
  }

  void stops() {
    std::vector<Eigen::Vector2d> climatology;
    std::vector<double> x, y;
    for (const MeasuredBlock& block : campaign_.blocks)
      if (!block.holdout && block.stop) {
        climatology.push_back(*block.stop);
        x.push_back(block.stop->x());
        y.push_back(block.stop->y());
      }
    if (climatology.size() < 2) return;
    const double spread = std::sqrt(variance_of(x) + variance_of(y));
    if (!(spread > 0.0)) return;
    std::vector<Eigen::Vector2d> places;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      if (!block.stop) return;
      places.clear();
      for (std::uint32_t t = 0; t < runs_[b].trials; ++t)
        if (!std::isnan(runs_[b].x[t])) places.emplace_back(runs_[b].x[t], runs_[b].y[t]);
      const bool unseen = places.size() < fewest_simulated_;
      row(b, fair_energy_score(unseen ? climatology : places, *block.stop) / spread, unseen);
    });
    close("stop");
  }

  /// Scores masses only where blocks broke: at least five changed their mass by more than a twentieth.
  void masses() {
    const auto share = [](const MeasuredBlock& b) { return b.stop_mass ? *b.stop_mass / b.mass : kNotGiven; };
    const auto changed = std::count_if(campaign_.blocks.begin(), campaign_.blocks.end(),
                                       [&](const MeasuredBlock& b) { return std::abs(share(b) - 1.0) > 0.05; });
    if (changed < static_cast<std::ptrdiff_t>(kFewestRows)) return;
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

  /// Brier score of the share of trials that crossed, over p (1 - p) of the fitting rows.
  void crossings(const std::string& name, std::size_t screen) {
    double fitting = 0.0, hits = 0.0;
    std::size_t asked = 0, asked_hits = 0;
    for (std::size_t b = 0; b < campaign_.blocks.size(); ++b) {
      const MeasuredBlock& block = campaign_.blocks[b];
      const bool hit = block.passages[screen].has_value();
      if (!block.holdout) fitting += 1.0, hits += hit ? 1.0 : 0.0;
      if (ask_[b]) ++asked, asked_hits += hit ? 1 : 0;
    }
    const double p = hits / fitting, spread = p * (1.0 - p);
    if (!(spread > 0.0) || std::min(asked_hits, asked - asked_hits) < kFewestRows) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      keep_finite(runs_[b].screens[screen].speed, values_);
      const double share = static_cast<double>(values_.size()) / std::max(1.0, static_cast<double>(runs_[b].trials));
      const double miss = share - (block.passages[screen] ? 1.0 : 0.0);
      row(b, miss * miss / spread);
    });
    close(name);
  }

  /// A group of one number per block.
  void one_value(const std::string& name, const std::function<double(const MeasuredBlock&)>& measured,
                 const std::function<const std::vector<double>&(std::uint32_t)>& simulated, std::size_t fewest) {
    std::vector<double> climatology;
    for (const MeasuredBlock& block : campaign_.blocks)
      if (!block.holdout && !std::isnan(measured(block))) climatology.push_back(measured(block));
    if (climatology.size() < fewest) return;
    const double spread = std::sqrt(variance_of(climatology));
    if (!(spread > 0.0)) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      const double y = measured(block);
      if (std::isnan(y)) return;
      const double score = crps_or_climatology(simulated(b), climatology, y) / spread;
      row(b, score, unseen());
    });
    close(name);
  }

  /// States along the path: several of a block, which counts once, with their mean.
  void samples(const char* name, double Sample::*measured, std::vector<double> BlockRuns::AtSample::*simulated) {
    std::vector<double> climatology;
    for (const MeasuredBlock& block : campaign_.blocks)
      for (const Sample& sample : block.samples)
        if (!block.holdout && !std::isnan(sample.*measured)) climatology.push_back(sample.*measured);
    if (climatology.size() < kFewestRows) return;
    const double spread = std::sqrt(variance_of(climatology));
    if (!(spread > 0.0)) return;
    for_asked([&](std::uint32_t b, const MeasuredBlock& block) {
      double sum = 0.0;
      int count = 0, not_seen = 0;
      for (std::size_t i = 0; i < block.samples.size(); ++i) {
        if (std::isnan(block.samples[i].*measured)) continue;
        sum += crps_or_climatology(runs_[b].samples[i].*simulated, climatology, block.samples[i].*measured);
        ++count;
        not_seen += unseen() ? 1 : 0;
      }
      if (count > 0) row(b, sum / count / spread, not_seen == count);
    });
    close(name);
  }

  /// CRPS of the simulated values or, where they are too few, of the values of the fitting rows.
  double crps_or_climatology(const std::vector<double>& simulated, std::vector<double>& climatology, double measured) {
    keep_finite(simulated, values_);
    return fair_crps(unseen() ? climatology : values_, measured);
  }
  bool unseen() const { return values_.size() < fewest_simulated_; }  // of the values scored last

  const Campaign& campaign_;
  std::span<const BlockRuns> runs_;
  const std::vector<bool>& ask_;
  const std::size_t fewest_simulated_;
  std::vector<RowScore> rows_;  // of the group under way
  std::vector<double> values_;
  Score score_;
};

}  // namespace

double fair_crps(std::span<double> simulated, double measured) {
  std::sort(simulated.begin(), simulated.end());
  const auto n = static_cast<double>(simulated.size());
  double distance = 0.0, pairs = 0.0;  // pairs: sum over i < j of x_j - x_i, by the rank of each value
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    distance += std::abs(simulated[i] - measured);
    pairs += (2.0 * static_cast<double>(i) - (n - 1.0)) * simulated[i];
  }
  return distance / n - pairs / (n * (n - 1.0));
}

double fair_energy_score(std::span<const Eigen::Vector2d> simulated, const Eigen::Vector2d& measured) {
  const auto n = static_cast<double>(simulated.size());
  double distance = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    distance += (simulated[i] - measured).norm();
    for (std::size_t j = 0; j < i; ++j) pairs += (simulated[i] - simulated[j]).norm();
  }
  return distance / n - pairs / (n * (n - 1.0));
}

Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            std::size_t fewest_simulated) {
  return Scorer(campaign, runs, ask, fewest_simulated).result();
}

Score weigh_groups(Score score) {
  double sum = 0.0, weights = 0.0;
  for (GroupScore& group : score.groups) {
    group.weight = group.rows / (group.rows + kHalfWeight);
    sum += group.weight * group.score;
    weights += group.weight;
  }
  if (!score.groups.empty()) score.total = sum / weights;
  return score;
}

std::size_t fewest_simulated_of(std::uint32_t trials) {
  return std::clamp<std::size_t>((trials + 9) / 10, 2, kFewestSimulated);
}

}  // namespace talus
