#include "talus/fit/diagnose/property_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What makes a rock: releases of equal axes, mass and density are taken to be of the same one.
using Rock = std::array<double, 5>;

Rock rock_of(const MeasuredBlock& b) {
  return {b.axes.x(), b.axes.y(), b.axes.z(), b.mass, b.density};
}

/// Blocks with a number, in the order of their streams, so that sums do not hang on the order of the file.
std::vector<std::size_t> used_blocks(const Campaign& campaign, const std::vector<double>& energy) {
  std::vector<std::size_t> blocks;
  for (std::size_t b = 0; b < energy.size(); ++b)
    if (!std::isnan(energy[b])) blocks.push_back(b);
  std::sort(blocks.begin(), blocks.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(campaign.blocks[a].stream, campaign.blocks[a].id) <
           std::pair(campaign.blocks[b].stream, campaign.blocks[b].id);
  });
  return blocks;
}

/// The blocks with their numbers, streams and groups.
struct Releases {
  std::vector<std::size_t> blocks;
  VectorXd energy;
  Units units;  // strata: groups

  Releases(const Campaign& campaign, std::vector<std::size_t> used, const std::vector<double>& all)
      : blocks(std::move(used)), energy(std::ssize(blocks)) {
    std::map<std::string, std::size_t> groups;
    for (const std::size_t b : blocks) groups.emplace(campaign.blocks[b].group, 0);
    std::size_t number = 0;
    for (auto& [name, value] : groups) value = number++;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const MeasuredBlock& b = campaign.blocks[blocks[i]];
      energy[static_cast<Index>(i)] = all[blocks[i]];
      units.streams.push_back(b.stream);
      units.strata.push_back(groups.at(b.group));
    }
  }
};

/// Whether different rocks were released in one of the groups: groups are then sites.
bool groups_are_sites(const Campaign& campaign, const Releases& releases) {
  std::map<std::size_t, std::set<Rock>> rocks;
  for (std::size_t i = 0; i < releases.blocks.size(); ++i)
    rocks[releases.units.strata[i]].insert(rock_of(campaign.blocks[releases.blocks[i]]));
  return std::ranges::any_of(rocks, [](const auto& group) { return group.second.size() > 1; });
}

/// Logarithms of L1/L2, L1/L3 and the mass.
MatrixXd properties_of(const Campaign& campaign, const std::vector<std::size_t>& blocks) {
  MatrixXd x(std::ssize(blocks), 3);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const MeasuredBlock& b = campaign.blocks[blocks[i]];
    x.row(static_cast<Index>(i)) << std::log(b.axes.x() / b.axes.y()), std::log(b.axes.x() / b.axes.z()),
        std::log(b.mass);
  }
  return x;
}

/// Releases of one rock become one unit: the mean of their numbers, less the means of their sites.
void join_rocks(const Campaign& campaign, Releases& releases) {
  const VectorXd rest = within_strata(releases.energy, releases.units.strata);
  std::map<Rock, std::vector<Index>> rocks;
  for (std::size_t i = 0; i < releases.blocks.size(); ++i)
    rocks[rock_of(campaign.blocks[releases.blocks[i]])].push_back(static_cast<Index>(i));
  Releases joined = releases;
  joined.energy.resize(std::ssize(rocks));
  joined.blocks.clear(), joined.units.streams.clear();
  for (const auto& [rock, members] : rocks) {
    const auto first = static_cast<std::size_t>(members.front());
    joined.energy[std::ssize(joined.blocks)] = rest(members).mean();
    joined.blocks.push_back(releases.blocks[first]);
    joined.units.streams.push_back(releases.units.streams[first]);
  }
  joined.units.strata.assign(joined.blocks.size(), 0);
  releases = std::move(joined);
}

/// What a campaign brings to a test: units that may change places, with their numbers and their properties.
struct SiteUnits {
  VectorXd energy;
  MatrixXd x;
  Units units;
  std::size_t blocks = 0, rocks = 0, sites = 0;
  bool by_rock = false;
};

SiteUnits units_of(const BlockNumbers& site) {
  const Campaign& campaign = site.campaign;
  Releases releases(campaign, used_blocks(campaign, site.values), site.values);
  SiteUnits out;
  out.blocks = releases.blocks.size();
  std::set<Rock> rocks;
  for (const std::size_t b : releases.blocks) rocks.insert(rock_of(campaign.blocks[b]));
  out.rocks = rocks.size();
  if (!groups_are_sites(campaign, releases)) releases.units.strata.assign(out.blocks, 0);
  out.sites = std::set<std::size_t>(releases.units.strata.begin(), releases.units.strata.end()).size();
  out.by_rock = 2 * out.rocks <= out.blocks;
  if (out.by_rock && out.blocks > 0) join_rocks(campaign, releases);
  out.energy = std::move(releases.energy);
  out.x = properties_of(campaign, releases.blocks);
  out.units = std::move(releases.units);
  return out;
}

/// The units of several campaigns. Their strata stay apart, so that none changes places with one of another campaign.
SiteUnits joined(std::vector<SiteUnits> sites) {
  if (sites.size() == 1) return std::move(sites.front());
  SiteUnits all;
  for (const SiteUnits& site : sites) {
    const Index before = all.energy.size(), more = site.energy.size();
    all.energy.conservativeResize(before + more);
    all.energy.tail(more) = site.energy;
    all.x.conservativeResize(before + more, 3);
    all.x.bottomRows(more) = site.x;
    for (const std::size_t stratum : site.units.strata) all.units.strata.push_back(all.sites + stratum);
    all.units.streams.insert(all.units.streams.end(), site.units.streams.begin(), site.units.streams.end());
    all.blocks += site.blocks;
    all.rocks += site.rocks;
    all.sites += site.sites;
    all.by_rock = all.by_rock || site.by_rock;
  }
  return all;
}

}  // namespace

PropertyTest property_test(const Campaign& campaign, const std::vector<double>& energy, const DiagnosisRules& rules,
                           std::uint64_t seed) {
  return property_test(std::vector<BlockNumbers>{{campaign, energy}}, rules, seed);
}

PropertyTest property_test(std::span<const BlockNumbers> sites, const DiagnosisRules& rules, std::uint64_t seed) {
  std::vector<SiteUnits> each;
  for (const BlockNumbers& site : sites) each.push_back(units_of(site));
  const SiteUnits all = joined(std::move(each));
  PropertyTest test;
  test.blocks = all.blocks;
  if (test.blocks < rules.fewest_blocks) return test;
  test.rocks = all.rocks;
  test.sites = all.sites;
  test.by_rock = all.by_rock;
  test.names = {"log L1/L2", "log L1/L3", "log mass"};
  test.slopes = slopes(all.energy, all.x, all.units.strata);
  test.regression = regression_test(all.energy, all.x, all.units, rules.arrangements, seed);
  test.tested = test.regression.properties > 0;
  return test;
}

DayTest day_test(const Campaign& campaign, const std::vector<double>& energy, const DiagnosisRules& rules,
                 std::uint64_t seed) {
  std::vector<std::size_t> used = used_blocks(campaign, energy);
  std::erase_if(used, [&](std::size_t b) { return campaign.blocks[b].day == 0; });  // not known
  const Releases releases(campaign, std::move(used), energy);
  DayTest test;
  test.blocks = releases.blocks.size();
  std::map<int, std::vector<Index>> days;
  for (std::size_t i = 0; i < test.blocks; ++i)
    days[campaign.blocks[releases.blocks[i]].day].push_back(static_cast<Index>(i));
  if (test.blocks < rules.fewest_blocks || days.size() < 2) return test;
  MatrixXd x = MatrixXd::Zero(std::ssize(releases.blocks), std::ssize(days));
  const VectorXd rest = within_strata(releases.energy, releases.units.strata);
  for (const auto& [day, members] : days) {
    for (const Index i : members) x(i, std::ssize(test.days)) = 1.0;
    test.days.push_back(day);
    test.means.push_back(rest(members).mean());
  }
  test.regression = regression_test(releases.energy, x, releases.units, rules.arrangements, seed);
  test.tested = test.regression.properties > 0;
  return test;
}

}  // namespace talus
