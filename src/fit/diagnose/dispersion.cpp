#include "talus/fit/diagnose/dispersion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {
namespace {

using Eigen::Index;

constexpr double kP95 = 1.6448536269514722;
constexpr double kFewest = 10.0;  // freedom that a row needs

/// Places z of some observables by block.
using Places = std::vector<Residual>;

/// A row of the test: the observables that it sums up, of one kind.
struct Scatter {
  std::string what;
  std::vector<std::size_t> observables;
  bool tail = false;
};

const char* name_of(Observable::Kind kind) {
  using Kind = Observable::Kind;
  switch (kind) {
    case Kind::Runout:
      return "runout";
    case Kind::Lateral:
      return "lateral";
    case Kind::Speed:
      return "speed";
    case Kind::Jump:
      return "jump";
    case Kind::Spin:
      return "spin";
    case Kind::SampleSpeed:
      return "sample speed";
    case Kind::SampleSpin:
      return "sample spin";
    case Kind::Mass:
    case Kind::Crossed:
      break;  // a share that is mostly 1, and yes or no: they have no spread of their own
  }
  return nullptr;
}

std::vector<Scatter> scatters_of(const ResidualSpace& space) {
  std::vector<Scatter> list;
  for (std::size_t o = 0; o < space.observables().size(); ++o) {
    const char* name = name_of(space.observables()[o].kind);
    if (name == nullptr) continue;
    auto row = std::find_if(list.begin(), list.end(), [&](const Scatter& s) { return s.what == name; });
    if (row == list.end()) row = list.insert(row, {name, {}, false});
    row->observables.push_back(o);
  }
  const auto runout = std::find_if(list.begin(), list.end(), [](const Scatter& s) { return s.what == "runout"; });
  if (runout != list.end()) list.push_back({"runout beyond P95", runout->observables, true});
  return list;
}

/// Number of the group of each block. Groups that would leave less than half of the freedom are not used.
std::vector<std::size_t> groups_of(const Campaign& campaign, const std::vector<std::size_t>& blocks) {
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> groups;
  for (const std::size_t b : blocks)
    groups.push_back(numbers.emplace(campaign.blocks[b].group, numbers.size()).first->second);
  if (2 * numbers.size() > blocks.size()) groups.assign(blocks.size(), 0);
  return groups;
}

struct Scattered {
  double statistic = 1.0, freedom = 0.0;
};

/// z of an observable, of the blocks of which it was seen, less the mean of their group.
std::vector<double> about_groups(const Places& places, Index observable, const std::vector<std::size_t>& groups,
                                 double& freedom) {
  std::vector<double> sums(groups.size(), 0.0), counts = sums, about;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!std::isnan(places[i][observable])) sums[groups[i]] += places[i][observable], counts[groups[i]] += 1.0;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!std::isnan(places[i][observable]))
      about.push_back(places[i][observable] - sums[groups[i]] / counts[groups[i]]);
  freedom = static_cast<double>(
      about.size() - static_cast<std::size_t>(std::ranges::count_if(counts, [](double n) { return n > 0.0; })));
  return about;
}

/// Share of z beyond P95: of z itself, as about the mean of a group nothing would be beyond where all are.
double share_beyond_p95(const Scatter& scatter, const Places& places) {
  double beyond = 0.0, seen = 0.0;
  for (const std::size_t o : scatter.observables)
    for (const Residual& place : places) {
      const double z = place[static_cast<Index>(o)];
      if (std::isnan(z)) continue;
      beyond += z > kP95 ? 1.0 : 0.0;
      seen += 1.0;
    }
  return beyond / seen;
}

/// Mean square about the means of the groups, over the freedom that they leave; of a tail the share beyond P95.
Scattered measure(const Scatter& scatter, const Places& places, const std::vector<std::size_t>& groups) {
  Scattered out;
  double squares = 0.0;
  for (const std::size_t o : scatter.observables) {
    double freedom = 0.0;
    for (const double z : about_groups(places, static_cast<Index>(o), groups, freedom)) squares += z * z;
    out.freedom += freedom;
  }
  if (out.freedom > 0.0) out.statistic = scatter.tail ? share_beyond_p95(scatter, places) : squares / out.freedom;
  return out;
}

/// Residuals of a data set drawn from the model: of one trial of each block.
Places drawn(const Campaign& campaign, const std::vector<std::size_t>& blocks,
             const std::vector<std::vector<Residual>>& trials, std::uint64_t seed, int replicate) {
  Places places;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double share =
        draw_of_block(seed, campaign.blocks[blocks[i]].stream, static_cast<std::uint32_t>(replicate), BlockDraw::Trial);
    places.push_back(trials[i][static_cast<std::size_t>(share * static_cast<double>(trials[i].size()))]);
  }
  return places;
}

/// How rare each value is among all: less its distance from their mean in standard deviations, in either direction; of
/// a tail upwards only. The smallest is the rarest.
std::vector<double> rarity_of(const std::vector<double>& values, bool tail) {
  const auto scale = [tail](double v) { return tail ? v : std::log(std::max(v, 1e-12)); };
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += scale(v);
  for (const double v : values) squares += std::pow(scale(v) - sum / n, 2);
  const double sd = std::sqrt(std::max(squares / n, 1e-300));
  std::vector<double> rarity;
  for (const double v : values) {
    const double away = (scale(v) - sum / n) / sd;
    rarity.push_back(tail ? -away : -std::abs(away));
  }
  return rarity;
}

}  // namespace

DispersionTest dispersion_test(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& runs,
                               const std::vector<bool>& rows, int replicates, std::uint64_t seed) {
  std::vector<std::size_t> blocks;
  std::vector<std::vector<Residual>> trials;
  Places measured;
  for (std::size_t b = 0; b < rows.size(); ++b) {
    if (!rows[b] || runs[b].trials == 0) continue;
    blocks.push_back(b);
    measured.push_back(space.of_measured(b));
    trials.emplace_back();
    for (std::size_t t = 0; t < runs[b].trials; ++t) trials.back().push_back(space.of_own_trial(b, runs[b], t));
  }
  const std::vector<std::size_t> groups = groups_of(campaign, blocks);
  std::vector<Scatter> scatters = scatters_of(space);
  std::erase_if(scatters, [&](const Scatter& s) { return measure(s, measured, groups).freedom < kFewest; });
  DispersionTest test;
  if (scatters.empty()) return test;
  std::vector<std::vector<double>> values(scatters.size());  // by row: of the drawn sets, then the measured one
  for (int replicate = 0; replicate < replicates; ++replicate) {
    const Places places = drawn(campaign, blocks, trials, seed, replicate);
    for (std::size_t s = 0; s < scatters.size(); ++s)
      values[s].push_back(measure(scatters[s], places, groups).statistic);
  }
  std::vector<double> own;
  for (std::size_t s = 0; s < scatters.size(); ++s) {
    const double expected = std::accumulate(values[s].begin(), values[s].end(), 0.0) / replicates;
    const double statistic = measure(scatters[s], measured, groups).statistic;
    values[s].push_back(statistic);
    values[s] = rarity_of(values[s], scatters[s].tail);
    own.push_back(values[s].back());
    values[s].pop_back();
    test.rows.push_back({scatters[s].what, statistic, expected, 1.0});
  }
  const Corrected p = corrected(values, own);
  for (std::size_t s = 0; s < scatters.size(); ++s) test.rows[s].p_value = p.effects[s];
  test.p_value = p.all;
  test.tested = true;
  return test;
}

}  // namespace talus
