#include "talus/fit/score/coverage.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "fitting_values.hpp"
#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/score/holm.hpp"
#include "talus/fit/score/score.hpp"
#include "talus/fit/score/tail.hpp"

namespace talus {
namespace {

constexpr std::uint64_t kRankSeed = 1;  // of the places between equal values

namespace policies = boost::math::policies;
/// Its quantile p is the smallest count k for which counts of at most k have a probability of p or more.
using Binomial =
    boost::math::binomial_distribution<double,
                                       policies::policy<policies::discrete_quantile<policies::integer_round_up>>>;

/// Ranks of one observable.
class Ranks {
 public:
  explicit Ranks(std::string observable) : number_(stream_of_name(observable)) {
    coverage_.observable = std::move(observable);
  }

  /// @param simulated  NaN where nothing was seen
  /// @param beyond     further simulated values, all larger than any measured one
  void add(const MeasuredBlock& block, double measured, std::span<const double> simulated, std::uint32_t beyond = 0) {
    if (std::isnan(measured)) return;
    keep_finite(simulated, values_);
    values_.insert(values_.end(), beyond, std::numeric_limits<double>::infinity());
    if (values_.size() < kFewestSimulated) {
      ++coverage_.unseen;
      return;
    }
    const double rank =
        random_rank(values_, measured, draw_of_block(kRankSeed, block.stream, number_, BlockDraw::RankOfTie));
    ++coverage_.rows;
    ++coverage_.ranks[std::min(kRankClasses - 1, static_cast<std::size_t>(rank * kRankClasses))];
    for (std::size_t i = 0; i < kCoverageShares.size(); ++i)
      if (rank < kCoverageShares[i]) ++coverage_.below[i].count;
  }

  void add_to(std::vector<Coverage>& list) {
    if (coverage_.rows < kFewestRows) return;
    for (std::size_t i = 0; i < kCoverageShares.size(); ++i) test(coverage_.below[i], kCoverageShares[i]);
    coverage_.expected_in_class = middle_of_counts(Binomial(coverage_.rows, 1.0 / kRankClasses));
    list.push_back(std::move(coverage_));
  }

 private:
  void test(ShareBelow& below, double share) const {
    const Binomial right(coverage_.rows, share);
    const double at_most = boost::math::cdf(right, below.count);
    const double at_least =
        below.count == 0 ? 1.0 : boost::math::cdf(boost::math::complement(right, below.count - 1.0));
    below.p_value = std::min(1.0, 2.0 * std::min(at_most, at_least));
    below.expected = middle_of_counts(right);
  }

  static Interval middle_of_counts(const Binomial& counts) {
    return {boost::math::quantile(counts, kTail), boost::math::quantile(counts, 1.0 - kTail)};
  }

  Coverage coverage_;
  std::uint32_t number_;
  std::vector<double> values_;
};

void add_screen(std::vector<Coverage>& list, const Campaign& campaign, std::span<const BlockRuns> runs,
                const std::vector<bool>& ask, std::size_t screen) {
  const auto add = [&](const char* name, double Passage::*measured, std::vector<double> BlockRuns::AtScreen::*values) {
    Ranks ranks(name + campaign.screens[screen].id);
    for (std::size_t b = 0; b < campaign.blocks.size(); ++b) {
      const auto& passage = campaign.blocks[b].passages[screen];
      if (ask[b] && passage) ranks.add(campaign.blocks[b], (*passage).*measured, runs[b].screens[screen].*values);
    }
    ranks.add_to(list);
  };
  add("speed ", &Passage::speed, &BlockRuns::AtScreen::speed);
  add("jump ", &Passage::jump, &BlockRuns::AtScreen::jump);
  add("spin ", &Passage::spin, &BlockRuns::AtScreen::spin);
}

void correct(std::vector<Coverage>& list) {
  std::vector<double> p;
  for (const Coverage& c : list)
    for (const ShareBelow& below : c.below) p.push_back(below.p_value);
  const std::vector<double> corrected = holm(p);
  auto next = corrected.begin();
  for (Coverage& c : list)
    for (ShareBelow& below : c.below) below.corrected = *next++;
}

}  // namespace

double random_rank(std::span<const double> simulated, double measured, double draw) {
  double below = 0.0, equal = 0.0;
  for (const double value : simulated) {
    if (value < measured) below += 1.0;
    if (value == measured) equal += 1.0;
  }
  return (below + draw * (equal + 1.0)) / (static_cast<double>(simulated.size()) + 1.0);
}

std::vector<Coverage> coverage(const Campaign& campaign, std::span<const BlockRuns> runs,
                               const std::vector<bool>& ask) {
  std::vector<Coverage> list;
  Ranks runout("runout");
  const bool left_are_farther = all_at_rest(campaign, ask);
  for (std::size_t b = 0; b < campaign.blocks.size(); ++b)
    if (ask[b])
      runout.add(campaign.blocks[b], runout_of(campaign, campaign.blocks[b]),
                 runouts_of(campaign, campaign.blocks[b], runs[b]),
                 left_are_farther ? runs[b].ends[static_cast<std::size_t>(End::Left)] : 0);
  runout.add_to(list);
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) add_screen(list, campaign, runs, ask, s);
  correct(list);
  return list;
}

LeavingTest leaving_test(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask) {
  LeavingTest out;
  if (campaign.deposits != nullptr) return out;
  std::vector<double> law{1.0};  // probability that no block leaves, that one does, ...
  for (std::size_t b = 0; b < campaign.blocks.size(); ++b) {
    if (!ask[b] || runs[b].trials == 0) continue;
    const double left = runs[b].ends[static_cast<std::size_t>(End::Left)], trials = runs[b].trials;
    const bool missing = !campaign.blocks[b].stop;
    ++out.blocks;
    out.missing += missing ? 1 : 0;
    out.expected += left / trials;
    const double p = (left + (missing ? 1.0 : 0.0)) / (trials + 1.0);
    law.push_back(0.0);
    for (std::size_t n = law.size() - 1; n > 0; --n) law[n] = law[n] * (1.0 - p) + law[n - 1] * p;
    law[0] *= 1.0 - p;
  }
  if (out.blocks < kFewestRows) return out;
  const auto first = law.begin(), missing = first + static_cast<std::ptrdiff_t>(out.missing);
  out.p_value = std::min(1.0, std::accumulate(first, missing + 1, 0.0));
  out.p_if_all_left = std::min(1.0, std::accumulate(missing, law.end(), 0.0));
  return out;
}

}  // namespace talus
