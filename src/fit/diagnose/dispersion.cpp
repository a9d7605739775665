#include "talus/fit/diagnose/dispersion.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "talus/fit/diagnose/corrected.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kP95 = 1.6448536269514722;
/// Freedom that a kind needs: blocks less groups, of all its observables.
constexpr std::size_t kFewest = 10;

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

std::vector<Scatters::Kind> kinds_of(const ResidualSpace& space) {
  std::vector<Scatters::Kind> list;
  for (std::size_t o = 0; o < space.observables().size(); ++o) {
    const char* name = name_of(space.observables()[o].kind);
    if (name == nullptr) continue;
    auto kind = std::ranges::find(list, name, &Scatters::Kind::what);
    if (kind == list.end()) kind = list.insert(kind, {name, {}, false});
    kind->observables.push_back(static_cast<Index>(o));
  }
  const auto runout = std::ranges::find(list, "runout", &Scatters::Kind::what);
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

/// Squares of z about the means of the groups.
struct Squares {
  double sum = 0.0;
  std::size_t freedom = 0;
};

Squares about_groups(const Scatters::Kind& kind, const MatrixXd& residuals, const std::vector<std::size_t>& groups) {
  Squares out;
  for (const Index o : kind.observables) {
    std::vector<double> sums(groups.size(), 0.0), counts = sums;
    for (std::size_t i = 0; i < groups.size(); ++i)
      if (const double z = residuals(o, static_cast<Index>(i)); !std::isnan(z))
        sums[groups[i]] += z, counts[groups[i]] += 1.0, ++out.freedom;
    for (std::size_t i = 0; i < groups.size(); ++i)
      if (const double z = residuals(o, static_cast<Index>(i)); !std::isnan(z))
        out.sum += std::pow(z - sums[groups[i]] / counts[groups[i]], 2);
    out.freedom -= static_cast<std::size_t>(std::ranges::count_if(counts, [](double n) { return n > 0.0; }));
  }
  return out;
}

/// Share of z beyond P95, of those that were seen: of z itself, as about the mean of a group nothing would be beyond
/// where all are.
double share_beyond_p95(const Scatters::Kind& kind, const MatrixXd& residuals) {
  double beyond = 0.0, seen = 0.0;
  for (const Index o : kind.observables)
    for (const double z : residuals.row(o)) {
      if (std::isnan(z)) continue;
      beyond += z > kP95 ? 1.0 : 0.0;
      seen += 1.0;
    }
  return seen > 0.0 ? beyond / seen : 0.0;
}

/// Numbers that are about normal: the logarithm of a variance, a share as it is.
VectorXd scaled(const VectorXd& statistics, bool tail) {
  return tail ? statistics : VectorXd(statistics.cwiseMax(1e-12).array().log());
}

/// How rare numbers are among some that scatter as `drawn`: less their distance from its mean in standard deviations,
/// either way; of a tail upwards only. The smallest is the rarest.
std::vector<double> rarity_of(const VectorXd& numbers, const VectorXd& drawn, bool tail) {
  const double mean = drawn.mean();
  const double sd = std::sqrt(std::max((drawn.array() - mean).square().mean(), 1e-300));
  std::vector<double> rarity;
  for (const double number : numbers) rarity.push_back(-(tail ? number - mean : std::abs(number - mean)) / sd);
  return rarity;
}

}  // namespace

Scatters::Scatters(const Campaign& campaign, const ResidualSpace& space, const std::vector<std::size_t>& blocks,
                   const MatrixXd& measured)
    : kinds_(kinds_of(space)), groups_(groups_of(campaign, blocks)) {
  std::erase_if(kinds_, [&](const Kind& kind) { return about_groups(kind, measured, groups_).freedom < kFewest; });
}

VectorXd Scatters::of(const MatrixXd& residuals) const {
  VectorXd out(std::ssize(kinds_));
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const Squares squares = about_groups(kinds_[k], residuals, groups_);
    const double variance = squares.freedom > 0 ? squares.sum / static_cast<double>(squares.freedom) : 1.0;
    out[static_cast<Index>(k)] = kinds_[k].tail ? share_beyond_p95(kinds_[k], residuals) : variance;
  }
  return out;
}

DispersionTest dispersion_test(const std::vector<Scatters::Kind>& kinds, const MatrixXd& drawn,
                               const VectorXd& measured) {
  DispersionTest test;
  if (kinds.empty() || drawn.cols() == 0) return test;
  std::vector<std::vector<double>> rarity;  // by kind and drawn set
  std::vector<double> own;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const VectorXd of_sets = scaled(drawn.row(row).transpose(), kinds[k].tail);
    rarity.push_back(rarity_of(of_sets, of_sets, kinds[k].tail));
    own.push_back(rarity_of(scaled(measured.segment(row, 1), kinds[k].tail), of_sets, kinds[k].tail)[0]);
    test.rows.push_back({kinds[k].what, measured[row], 1.0});
  }
  const Corrected p = corrected(rarity, own);
  for (std::size_t k = 0; k < kinds.size(); ++k) test.rows[k].p_value = p.effects[k];
  test.p_value = p.all;
  test.tested = true;
  return test;
}

}  // namespace talus
