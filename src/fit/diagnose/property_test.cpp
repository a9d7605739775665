#include "talus/fit/diagnose/property_test.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "rocks.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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

std::size_t count_of(const std::vector<std::size_t>& numbers) {
  return std::set<std::size_t>(numbers.begin(), numbers.end()).size();
}

/// Whether different rocks were released in one of the groups: groups are then sites.
bool groups_are_sites(const std::vector<std::size_t>& groups, const std::vector<std::size_t>& rocks) {
  std::map<std::size_t, std::size_t> rock_of_group;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (rock_of_group.emplace(groups[i], rocks[i]).first->second != rocks[i]) return true;
  return false;
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

/// The rocks of a campaign, which the permutations exchange: of each the means over its releases.
struct SiteUnits {
  VectorXd energy;
  MatrixXd x;
  Units units;
  std::size_t blocks = 0, rocks = 0, sites = 0, strata = 0;
};

/// Rocks change places with those that were released at the same sites: only these have numbers of one distribution, as
/// the mean of a site was taken away with more or fewer releases elsewhere.
void set_strata(const std::map<std::size_t, std::set<std::size_t>>& sites_of_rock, SiteUnits& out) {
  std::map<std::set<std::size_t>, std::size_t> strata;
  for (const auto& [rock, sites] : sites_of_rock) strata.emplace(sites, 0);
  for (auto& [sites, number] : strata) number = out.strata++;
  for (const auto& [rock, sites] : sites_of_rock) out.units.strata.push_back(strata.at(sites));
}

/// Releases of one rock become one unit: the means of their numbers and properties, less the means of their sites.
SiteUnits units_of(const BlockNumbers& site) {
  const Releases releases(site.campaign, used_blocks(site.campaign, site.values), site.values);
  const std::vector<std::size_t> rocks = rocks_of(site.campaign, releases.blocks);
  std::vector<std::size_t> sites = releases.units.strata;
  if (!groups_are_sites(sites, rocks)) sites.assign(sites.size(), 0);
  SiteUnits out;
  out.blocks = releases.blocks.size();
  out.rocks = count_of(rocks);
  out.sites = count_of(sites);
  std::map<std::size_t, std::vector<Index>> members;
  std::map<std::size_t, std::set<std::size_t>> sites_of_rock;
  for (std::size_t i = 0; i < rocks.size(); ++i) {
    if (members[rocks[i]].empty()) out.units.streams.push_back(releases.units.streams[i]);
    members[rocks[i]].push_back(static_cast<Index>(i));
    sites_of_rock[rocks[i]].insert(sites[i]);
  }
  set_strata(sites_of_rock, out);
  const VectorXd energy = within_strata(releases.energy, sites);
  const MatrixXd x = within_strata(properties_of(site.campaign, releases.blocks), sites);
  out.energy.resize(std::ssize(members));
  out.x.resize(std::ssize(members), x.cols());
  for (const auto& [rock, rows] : members) {
    out.energy[static_cast<Index>(rock)] = energy(rows).mean();
    out.x.row(static_cast<Index>(rock)) = x(rows, Eigen::all).colwise().mean();
  }
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
    for (const std::size_t stratum : site.units.strata) all.units.strata.push_back(all.strata + stratum);
    all.units.streams.insert(all.units.streams.end(), site.units.streams.begin(), site.units.streams.end());
    all.blocks += site.blocks;
    all.rocks += site.rocks;
    all.sites += site.sites;
    all.strata += site.strata;
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
  test.rocks = all.rocks;
  test.sites = all.sites;
  test.by_rock = all.rocks < all.blocks;
  if (test.blocks < rules.fewest_blocks) return test;
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
