#include "talus/fit/diagnose/residual_table.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "rocks.hpp"
#include "talus/base/random.hpp"
#include "talus/fit/score/coverage.hpp"
#include "talus/fit/score/holm.hpp"

namespace talus {
namespace {

constexpr std::size_t kManyBlocks = 50;  // from which on Student's t is exact enough for a rank correlation
constexpr std::uint32_t kEnough = 50;    // arrangements as extreme as the measured one that give its p to 14 %
constexpr std::uint32_t kMostArrangements = 200'000;
constexpr double kFewestLeaving = 5.0;  // blocks by the model; with fewer the row is hardly ever significant

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return rank;
}

double two_sided(double tail) {
  return std::min(1.0, 2.0 * tail);
}

/// Puts numbers in a random order: number `arrangement` of those of `stream`.
void shuffle(std::vector<double>& values, std::uint32_t stream, std::uint32_t arrangement) {
  const Random random(0, stream, arrangement, Purpose::Bootstrap);
  Words words{};
  for (std::size_t left = values.size(), draw = 0; left > 1; --left, ++draw) {
    if (draw % words.size() == 0) words = random.words(static_cast<std::uint32_t>(draw / words.size()));
    const auto other = static_cast<std::size_t>(uniform(words[draw % words.size()]) * static_cast<double>(left));
    std::swap(values[left - 1], values[other]);
  }
}

/// Two-sided p of Spearman's rank correlation: the share of the arrangements of `a` whose correlation is as large. They
/// are drawn until enough of them are (Besag and Clifford 1991), which is a p-value, too. In the tail that decides
/// that of Student's t is too small, 1.6 times at 24 blocks.
double p_by_permutation(std::span<const double> a, std::span<const double> b, std::uint32_t stream) {
  std::vector<double> moved = ranks(a), fixed = ranks(b);
  for (double& rank : fixed) rank -= 0.5 * (static_cast<double>(b.size()) - 1.0);
  const auto product = [&] { return std::abs(std::inner_product(moved.begin(), moved.end(), fixed.begin(), 0.0)); };
  const double measured = product() * (1.0 - 1e-9);
  std::uint32_t as_large = 0;
  for (std::uint32_t arrangement = 1; arrangement <= kMostArrangements; ++arrangement) {
    shuffle(moved, stream, arrangement);
    if (product() >= measured && ++as_large == kEnough) return as_large / static_cast<double>(arrangement);
  }
  return (as_large + 1.0) / (kMostArrangements + 1.0);
}

double p_of_correlation(double r, std::size_t n) {
  const double freedom = static_cast<double>(n) - 2.0;
  const double t = std::abs(r) * std::sqrt(freedom / std::max(1e-12, 1.0 - r * r));
  return two_sided(boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), t)));
}

/// Adds Spearman's correlation of the ranks of the measured values with a property. Equal simulated values (jumps of 0)
/// are ranked at random: with mean ranks a block with many of them has other ranks than one with few, and where their
/// share depends on the property, a right model seems to depend on it.
void add_correlation(std::vector<ResidualRow>& table, const std::string& name, const char* property,
                     std::span<const double> rank, std::span<const double> of) {
  const double r = spearman(rank, of);
  const double p = rank.size() < kManyBlocks ? p_by_permutation(rank, of, stream_of_name(name + ' ' + property))
                                             : p_of_correlation(r, rank.size());
  table.push_back({name, property, r, p, 1.0, rank.size()});
}

/// Adds the test whether blocks with a large value of a property cross more often than the model says. The statistic is
/// the sum of (c - p) times the rank over its standard deviation, given the measured number of crossings. A rank
/// correlation is no test here: blocks that seldom cross have small residuals in any case, so residuals are correlated
/// with everything that the chance of a crossing depends on.
void add_crossing(std::vector<ResidualRow>& table, const std::string& name, const char* property,
                  const std::vector<double>& z, const std::vector<double>& variance, std::span<const double> of,
                  double fewest) {
  const std::vector<double> rank = ranks(of);
  const double all = std::accumulate(variance.begin(), variance.end(), 0.0);
  if (all < fewest) return;
  const double middle = std::inner_product(rank.begin(), rank.end(), variance.begin(), 0.0) / all;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    sum += (rank[i] - middle) * z[i] * std::sqrt(variance[i]);
    squares += (rank[i] - middle) * (rank[i] - middle) * variance[i];
  }
  if (!(squares > 0.0)) return;
  const double statistic = sum / std::sqrt(squares);
  const double tail = boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(statistic)));
  table.push_back({name, property, statistic, two_sided(tail), 1.0, z.size()});
}

/// Adds the tests of mean and spread of z against those of a right model. The sum of squares goes by the chi squared
/// distribution of its mean and variance (Satterthwaite 1946).
void add_moments(std::vector<ResidualRow>& table, const std::string& name, const std::vector<double>& z,
                 const std::vector<ResidualSpace::Moments>& expected) {
  const auto n = static_cast<double>(z.size());
  double mean = 0.0, variance = 0.0, scatter = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    mean += (z[i] - expected[i].mean) / n;
    variance += expected[i].variance / n;
    scatter += (expected[i].fourth - expected[i].variance * expected[i].variance) / n;
  }
  if (!(variance > 0.0 && scatter > 0.0)) return;  // the model gives every block one value
  const double standard = std::abs(mean) * std::sqrt(n / variance);
  table.push_back({name, "mean", mean,
                   two_sided(boost::math::cdf(boost::math::complement(boost::math::normal(), standard))), 1.0,
                   z.size()});
  double squares = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) squares += std::pow(z[i] - expected[i].mean - mean, 2);
  const double share = squares / ((n - 1.0) * variance);  // of what is expected
  const double freedom = 2.0 * (n - 1.0) * variance * variance / scatter;
  const boost::math::chi_squared law(freedom);
  const double tail =
      std::min(boost::math::cdf(law, share * freedom), boost::math::cdf(boost::math::complement(law, share * freedom)));
  table.push_back({name, "spread", share, two_sided(tail), 1.0, z.size()});
}

/// Number of the releases of each rock. @param rocks  of each block, numbered from 0
std::vector<double> releases_of(std::span<const std::size_t> rocks) {
  std::vector<double> releases(std::ranges::max(rocks) + 1, 0.0);
  for (const std::size_t rock : rocks) releases[rock] += 1.0;
  return releases;
}

/// The mean of a value over the releases of each rock.
std::vector<double> means_by(std::span<const std::size_t> rocks, std::span<const double> values) {
  const std::vector<double> releases = releases_of(rocks);
  std::vector<double> means(releases.size(), 0.0);
  for (std::size_t i = 0; i < rocks.size(); ++i) means[rocks[i]] += values[i] / releases[rocks[i]];
  return means;
}

/// The used blocks in the order of their streams: the permutations must not depend on the order of the file.
std::vector<std::size_t> in_order_of_streams(const Campaign& campaign, const std::vector<bool>& rows) {
  std::vector<std::size_t> order;
  for (std::size_t b = 0; b < campaign.blocks.size(); ++b)
    if (rows[b]) order.push_back(b);
  std::ranges::stable_sort(order, {}, [&](std::size_t b) { return campaign.blocks[b].stream; });
  return order;
}

/// Adds the test whether fewer blocks left the DEM than should.
void add_leaving(std::vector<ResidualRow>& table, const Campaign& campaign, const std::vector<BlockRuns>& runs,
                 const std::vector<bool>& rows) {
  const LeavingTest test = leaving_test(campaign, runs, rows);
  if (std::isnan(test.p_value) || test.expected < kFewestLeaving) return;
  table.push_back(
      {kLeaving, "number", static_cast<double>(test.missing) - test.expected, test.p_value, 1.0, test.blocks});
}

}  // namespace

const std::vector<Property>& properties() {
  static const std::vector<Property> list{
      {"mass", "kg", [](const MeasuredBlock& b) { return b.mass; }, true},
      {"L1/L2", "", [](const MeasuredBlock& b) { return b.axes.x() / b.axes.y(); }, true},
      {"L1/L3", "", [](const MeasuredBlock& b) { return b.axes.x() / b.axes.z(); }, true},
      {"day", "", [](const MeasuredBlock& b) { return b.day == 0 ? kNotGiven : static_cast<double>(b.day); }},
      {"release height", "m", [](const MeasuredBlock& b) { return b.release_height; }},
      {"east", "m", [](const MeasuredBlock& b) { return b.x; }},
      {"north", "m", [](const MeasuredBlock& b) { return b.y; }}};
  return list;
}

double spearman(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> ra = ranks(a), rb = ranks(b);
  const double middle = 0.5 * (static_cast<double>(a.size()) - 1.0);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (ra[i] - middle) * (rb[i] - middle);
    aa += (ra[i] - middle) * (ra[i] - middle);
    bb += (rb[i] - middle) * (rb[i] - middle);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

std::vector<ResidualRow> residual_table(const Campaign& campaign, const ResidualSpace& space,
                                        const std::vector<BlockRuns>& runs, const std::vector<bool>& rows,
                                        const DiagnosisRules& rules) {
  const std::vector<std::size_t> order = in_order_of_streams(campaign, rows);
  std::vector<ResidualRow> table;
  for (std::size_t o = 0; o < space.observables().size(); ++o) {
    const std::string& name = space.observables()[o].name;
    const bool crossing = space.observables()[o].kind == Observable::Kind::Crossed;
    std::vector<std::size_t> seen;
    std::vector<double> all;
    for (const std::size_t b : order) {
      const double z = space.of_measured(b)[static_cast<Eigen::Index>(o)];
      if (!std::isnan(z)) seen.push_back(b), all.push_back(z);
    }
    if (seen.size() < rules.fewest_blocks) continue;
    std::vector<ResidualSpace::Moments> expected;
    for (const std::size_t b : seen) expected.push_back(space.moments(b, o));
    if (!crossing) add_moments(table, name, all, expected);
    for (const Property& property : properties()) {
      std::vector<double> z, variance, rank, of;  // of the blocks whose property is known
      std::vector<std::size_t> known;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const double value = property.of(campaign.blocks[seen[i]]), p = space.crossing_share(seen[i], o);
        if (std::isnan(value)) continue;
        z.push_back(all[i]), variance.push_back(p * (1.0 - p)), of.push_back(value);
        rank.push_back(crossing ? kNotGiven : space.rank_of_measured(seen[i], o));
        known.push_back(seen[i]);
      }
      if (of.size() < rules.fewest_blocks || std::ranges::min(of) == std::ranges::max(of)) continue;
      if (property.of_rock) {
        const std::vector<std::size_t> rocks = rocks_of(campaign, known);
        const std::vector<double> releases = releases_of(rocks);
        const auto once = static_cast<std::size_t>(std::ranges::count(releases, 1.0));
        const bool again = once < releases.size();  // a rock was released more than once
        if (again && releases.size() < rules.fewest_rocks) continue;
        if (crossing && 2 * once < known.size()) continue;  // the test of crossings takes blocks for independent
        if (again && !crossing) rank = means_by(rocks, rank), of = means_by(rocks, of);
      }
      if (crossing)
        add_crossing(table, name, property.name, z, variance, of, rules.fewest_crossings);
      else
        add_correlation(table, name, property.name, rank, of);
    }
  }
  add_leaving(table, campaign, runs, rows);
  std::ranges::stable_sort(table, {}, &ResidualRow::p_value);
  correct_rows(table);
  return table;
}

}  // namespace talus
