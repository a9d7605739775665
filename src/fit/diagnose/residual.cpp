#include "talus/fit/diagnose/residual.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "pooled_products.hpp"
#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/score/coverage.hpp"

namespace talus {
namespace {

bool blocks_broke(const Campaign& campaign) {
  return std::count_if(campaign.blocks.begin(), campaign.blocks.end(), [](const MeasuredBlock& b) {
           return !b.holdout && b.stop_mass && std::abs(*b.stop_mass / b.mass - 1.0) > 0.05;
         }) >= 5;
}

/// Quantities that were measured of the fitting rows.
std::vector<Observable> observables_of(const Campaign& campaign) {
  using Kind = Observable::Kind;
  std::vector<Observable> list;
  const auto any = [&campaign](auto has) {
    return std::any_of(campaign.blocks.begin(), campaign.blocks.end(),
                       [&has](const MeasuredBlock& b) { return !b.holdout && has(b); });
  };
  const auto any_passage = [&any](std::size_t s, double Passage::*value) {
    return any([=](const MeasuredBlock& b) { return b.passages[s] && !std::isnan((*b.passages[s]).*value); });
  };
  const auto any_sample = [&any](double Sample::*value) {
    return any([value](const MeasuredBlock& b) {
      return std::any_of(b.samples.begin(), b.samples.end(), [&](const Sample& s) { return !std::isnan(s.*value); });
    });
  };
  if (any([](const MeasuredBlock& b) { return b.stop.has_value(); })) {
    list.push_back({Kind::Runout, 0, false, "runout"});
    list.push_back({Kind::Lateral, 0, false, "lateral"});
  }
  if (blocks_broke(campaign)) list.push_back({Kind::Mass, 0, false, "mass"});
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) {
    if (!any([s](const MeasuredBlock& b) { return b.passages[s].has_value(); })) continue;
    const std::string id = " " + campaign.screens[s].id;
    list.push_back({Kind::Crossed, s, false, "crossed" + id});
    if (any_passage(s, &Passage::speed)) list.push_back({Kind::Speed, s, false, "speed" + id});
    if (any_passage(s, &Passage::jump)) list.push_back({Kind::Jump, s, false, "jump" + id});
    if (any_passage(s, &Passage::spin)) list.push_back({Kind::Spin, s, false, "spin" + id});
  }
  for (const bool late : {false, true}) {
    const std::string when = late ? " late" : " early";
    if (any_sample(&Sample::speed)) list.push_back({Kind::SampleSpeed, 0, late, "sample speed" + when});
    if (any_sample(&Sample::spin)) list.push_back({Kind::SampleSpin, 0, late, "sample spin" + when});
  }
  return list;
}

/// Phi^-1 of the rank of a value among sorted ones; ties count half. A value that is one of them is ranked among the
/// others: a measured value has as many places to fall into as there are gaps between the simulated ones.
/// @param own  whether it is one of them
double rank_score(const std::vector<double>& sorted, double value, bool own, std::size_t fewest) {
  if (sorted.size() < fewest || std::isnan(value)) return kNotGiven;
  const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), value);
  const double itself = own ? 1.0 : 0.0, equal = static_cast<double>(high - low) - itself,
               others = static_cast<double>(sorted.size()) - itself;
  return normal_quantile((static_cast<double>(low - sorted.begin()) + 0.5 * equal + 0.5) / (others + 1.0));
}

std::vector<double> sorted_finite(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  std::sort(values.begin(), values.end());
  return values;
}

/// Direction in plan of the mean stop, seen from the release; where none stopped, east.
Eigen::Vector2d forward_of(const MeasuredBlock& block, const BlockRuns& runs) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& stop : stops_of(runs)) sum += stop - Eigen::Vector2d(block.x, block.y);
  return sum.norm() > 0.0 ? Eigen::Vector2d(sum.normalized()) : Eigen::Vector2d::UnitX();
}

/// Numbers of the samples of a block's nearer or farther half.
std::vector<std::size_t> half_of(const MeasuredBlock& block, bool late) {
  const std::size_t count = block.samples.size(), middle = (count + 1) / 2;
  std::vector<std::size_t> half(late ? count - middle : middle);
  std::iota(half.begin(), half.end(), late ? middle : 0);
  return half;
}

}  // namespace

double normal_quantile(double share) {
  return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * share);
}

ResidualSpace::ResidualSpace(const Campaign& campaign, const std::vector<BlockRuns>& runs, const DiagnosisRules& rules)
    : campaign_(campaign),
      rules_(rules),
      left_are_farther_(all_at_rest(campaign, fitting_rows(campaign))),
      observables_(observables_of(campaign)) {
  const std::size_t blocks = campaign.blocks.size(), n = observables_.size();
  distributions_.assign(blocks, std::vector<Sorted>(n));
  samples_.resize(blocks);
  crossing_share_.assign(blocks * n, 0.0);
  for (std::size_t b = 0; b < blocks; ++b) {
    forward_.push_back(forward_of(campaign.blocks[b], runs[b]));
    for (const BlockRuns::AtSample& sample : runs[b].samples)
      samples_[b].push_back({sorted_finite(sample.speed), sorted_finite(sample.spin)});
    std::vector<std::vector<double>> values(n);
    for (std::size_t t = 0; t < runs[b].trials; ++t) {
      const std::vector<double> v = values_of(b, seen_of_trial(b, runs[b], t), true);
      for (std::size_t o = 0; o < n; ++o) values[o].push_back(v[o]);
    }
    for (std::size_t o = 0; o < n; ++o) {
      if (observables_[o].kind == Observable::Kind::Crossed) {
        double sum = 0.5;
        for (const double v : values[o]) sum += v;
        crossing_share_[b * n + o] = sum / (static_cast<double>(runs[b].trials) + 1.0);
      }
      distributions_[b][o] = sorted_finite(std::move(values[o]));
    }
  }
  correlate(runs);
}

/// Mean score of a block's samples of one half, of those that have one.
double ResidualSpace::sample_score(std::size_t block, const Observable& o, const std::vector<double>& values,
                                   bool own) const {
  if (samples_[block].empty()) return kNotGiven;  // not simulated
  double sum = 0.0;
  int count = 0;
  const std::size_t which = o.kind == Observable::Kind::SampleSpeed ? 0 : 1;
  for (const std::size_t i : half_of(campaign_.blocks[block], o.late)) {
    const double score = rank_score(samples_[block][i][which], values[i], own, rules_.fewest_values);
    if (!std::isnan(score)) sum += score, ++count;
  }
  return count > 0 ? sum / count : kNotGiven;
}

ResidualSpace::Seen ResidualSpace::seen_measured(std::size_t b) const {
  const MeasuredBlock& block = campaign_.blocks[b];
  Seen seen;
  if (block.stop) seen.way = *block.stop - Eigen::Vector2d(block.x, block.y);
  if (block.stop_mass) seen.mass_share = *block.stop_mass / block.mass;
  seen.passages = block.passages;
  for (const Sample& sample : block.samples)
    seen.sample_speed.push_back(sample.speed), seen.sample_spin.push_back(sample.spin);
  return seen;
}

/// The measurements that a trial would have given. A value that was not measured of the block is missing in its trials,
/// too.
ResidualSpace::Seen ResidualSpace::seen_of_trial(std::size_t b, const BlockRuns& runs, std::size_t t) const {
  const MeasuredBlock& block = campaign_.blocks[b];
  const auto where_measured = [](double simulated, double measured) {
    return std::isnan(measured) ? kNotGiven : simulated;
  };
  Seen seen;
  if (block.stop && !std::isnan(runs.x[t])) seen.way = {runs.x[t] - block.x, runs.y[t] - block.y};
  seen.gone = block.stop && left_are_farther_ && t < runs.end.size() && runs.end[t] == End::Left;
  if (block.stop_mass && !std::isnan(runs.x[t])) seen.mass_share = runs.mass_share[t];
  for (std::size_t s = 0; s < runs.screens.size(); ++s) {
    const BlockRuns::AtScreen& screen = runs.screens[s];
    seen.passages.emplace_back();
    if (std::isnan(screen.speed[t])) continue;                                    // did not cross
    const Passage measured = block.passages[s].value_or(Passage{0.0, 0.0, 0.0});  // it would have been seen
    seen.passages.back() =
        Passage{where_measured(screen.speed[t], measured.speed), where_measured(screen.jump[t], measured.jump),
                where_measured(screen.spin[t], measured.spin)};
  }
  for (std::size_t i = 0; i < runs.samples.size(); ++i) {
    seen.sample_speed.push_back(where_measured(runs.samples[i].speed[t], block.samples[i].speed));
    seen.sample_spin.push_back(where_measured(runs.samples[i].spin[t], block.samples[i].spin));
  }
  return seen;
}

std::vector<double> ResidualSpace::values_of(std::size_t b, const Seen& seen, bool own) const {
  using Kind = Observable::Kind;
  std::vector<double> values;
  for (const Observable& o : observables_) {
    const bool at_screen = o.kind == Kind::Speed || o.kind == Kind::Jump || o.kind == Kind::Spin;
    const Passage passage = at_screen ? seen.passages[o.screen].value_or(Passage{}) : Passage{};
    switch (o.kind) {
      case Kind::Runout:
        values.push_back(seen.gone ? std::numeric_limits<double>::infinity() : seen.way.norm());
        break;
      case Kind::Lateral:
        values.push_back(forward_[b].x() * seen.way.y() - forward_[b].y() * seen.way.x());
        break;
      case Kind::Mass:
        values.push_back(seen.mass_share);
        break;
      case Kind::Crossed:
        values.push_back(seen.passages[o.screen] ? 1.0 : 0.0);
        break;
      case Kind::Speed:
        values.push_back(passage.speed);
        break;
      case Kind::Jump:
        values.push_back(passage.jump);
        break;
      case Kind::Spin:
        values.push_back(passage.spin);
        break;
      case Kind::SampleSpeed:
        values.push_back(sample_score(b, o, seen.sample_speed, own));
        break;
      case Kind::SampleSpin:
        values.push_back(sample_score(b, o, seen.sample_spin, own));
        break;
    }
  }
  return values;
}

Residual ResidualSpace::residual(std::size_t b, const std::vector<double>& values, bool own) const {
  const std::size_t n = observables_.size();
  Residual r = Residual::Constant(size(), kNotGiven);
  for (std::size_t o = 0; o < n; ++o) {
    const auto place = static_cast<Eigen::Index>(o), spread = static_cast<Eigen::Index>(n + o);
    if (observables_[o].kind == Observable::Kind::Crossed) {
      const auto trials = static_cast<double>(distributions_[b][o].size());
      const double p = own ? ((trials + 1.0) * crossing_share(b, o) - values[o]) / trials : crossing_share(b, o);
      r[place] = (values[o] - p) / std::sqrt(p * (1.0 - p));
      continue;
    }
    const double z = rank_score(distributions_[b][o], values[o], own, rules_.fewest_values);
    r[place] = z;
    r[spread] = (z * z - 1.0) / std::sqrt(2.0);
  }
  return r;
}

Residual ResidualSpace::of_measured(std::size_t block) const {
  return residual(block, values_of(block, seen_measured(block), false), false);
}

double ResidualSpace::rank_of_measured(std::size_t block, std::size_t observable) const {
  const Sorted& simulated = distributions_[block][observable];
  const double measured = values_of(block, seen_measured(block), false)[observable];
  if (simulated.size() < rules_.fewest_values || std::isnan(measured)) return kNotGiven;
  const std::uint32_t number = stream_of_name(observables_[observable].name);
  return random_rank(simulated, measured,
                     draw_of_block(0, campaign_.blocks[block].stream, number, BlockDraw::RankOfTie));
}

Residual ResidualSpace::of_trial(std::size_t block, const BlockRuns& runs, std::size_t trial) const {
  return residual(block, values_of(block, seen_of_trial(block, runs, trial), false), false);
}

Residual ResidualSpace::of_own_trial(std::size_t block, const BlockRuns& runs, std::size_t trial) const {
  return residual(block, values_of(block, seen_of_trial(block, runs, trial), true), true);
}

ResidualSpace::Moments ResidualSpace::moments(std::size_t block, std::size_t observable) const {
  const Sorted& values = distributions_[block][observable];
  if (std::ranges::adjacent_find(values) == values.end()) return {};
  std::vector<std::pair<double, double>> places;  // share of the values, z of each among the others
  const auto n = static_cast<double>(values.size());
  for (auto low = values.begin(); low != values.end();) {
    const auto high = std::upper_bound(low, values.end(), *low);
    const auto equal = static_cast<double>(high - low), below = static_cast<double>(low - values.begin());
    places.emplace_back(equal / n, normal_quantile((below + 0.5 * equal) / n));
    low = high;
  }
  Moments m{0.0, 0.0, 0.0};
  for (const auto& [share, z] : places) m.mean += share * z;
  for (const auto& [share, z] : places) {
    const double square = (z - m.mean) * (z - m.mean);
    m.variance += share * square;
    m.fourth += share * square * square;
  }
  return m;
}

void ResidualSpace::correlate(const std::vector<BlockRuns>& runs) {
  PooledProducts products(size());
  for (std::size_t b = 0; b < runs.size(); ++b)
    for (std::size_t t = 0; t < runs[b].trials; ++t) products.add(of_own_trial(b, runs[b], t));
  const Eigen::MatrixXd pooled = products.means();
  correlation_ = Eigen::MatrixXd::Identity(size(), size());
  for (Eigen::Index i = 0; i < size(); ++i)
    for (Eigen::Index j = 0; j < size(); ++j)
      if (i != j && pooled(i, i) > 0.0 && pooled(j, j) > 0.0)
        correlation_(i, j) =
            (1.0 - rules_.shrink) * std::clamp(pooled(i, j) / std::sqrt(pooled(i, i) * pooled(j, j)), -1.0, 1.0);
}

Eigen::VectorXd ResidualSpace::whitened(const Residual& r) const {
  std::vector<bool> seen(static_cast<std::size_t>(size()));
  std::vector<Eigen::Index> at;
  for (Eigen::Index i = 0; i < size(); ++i) {
    seen[static_cast<std::size_t>(i)] = !std::isnan(r[i]);
    if (!std::isnan(r[i])) at.push_back(i);
  }
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  if (at.empty()) return out;
  auto it = inverses_.find(seen);
  if (it == inverses_.end()) {
    const Eigen::MatrixXd part = correlation_(at, at);
    // Pairwise correlations need not fit together: lift the smallest eigenvalues.
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(part);
    const Eigen::VectorXd lifted = eigen.eigenvalues().cwiseMax(0.1).cwiseInverse();
    it = inverses_.emplace(seen, eigen.eigenvectors() * lifted.asDiagonal() * eigen.eigenvectors().transpose()).first;
  }
  out(at) = it->second * r(at);
  return out;
}

}  // namespace talus
