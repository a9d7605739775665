#include "talus/fit/diagnose/property_test.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "rocks.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Blocks with a number, in the order of their streams, so that sums do not depend on the order of the file.
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

/// The units that a permutation exchanges. A unit is a rock, with the means of its releases, or a single release.
struct SiteUnits {
  VectorXd energy;
  MatrixXd x;
  Units units;
  std::size_t blocks = 0, rocks = 0, sites = 0, strata = 0;
};

/// Units of one stratum change places. Only these have numbers of one distribution: the mean of a site was taken away
/// with more or fewer releases elsewhere, and a mean of few releases scatters more than one of many.
struct Stratum {
  std::set<std::size_t> sites;  ///< at which the unit was released
  int often = 0;         ///< how often it was released, as the rarest unit of its sites: 1; twice as often: 2; ...
  std::size_t rock = 0;  ///< of single releases of a rock 1 + its number, else 0

  auto operator<=>(const Stratum&) const = default;
};

/// The rock and the site of each release. A release that is `alone` is a unit; the other releases of a rock are one
/// unit.
struct Parts {
  std::vector<std::size_t> rocks, sites;
  std::vector<bool> alone;
};

/// A unit: its releases and its stratum.
struct TestUnit {
  std::vector<Index> releases;
  Stratum stratum;
};

/// Sorts the units of the same sites into those that were released less than twice as often as the rarest of them, less
/// than four times, ...
void class_by_number(std::vector<TestUnit>& list) {
  std::map<std::set<std::size_t>, std::size_t> rarest;
  for (const TestUnit& unit : list) {
    std::size_t& least = rarest.emplace(unit.stratum.sites, unit.releases.size()).first->second;
    least = std::min(least, unit.releases.size());
  }
  for (TestUnit& unit : list)
    unit.stratum.often = static_cast<int>(std::bit_width(unit.releases.size() / rarest.at(unit.stratum.sites)));
}

/// In the order of their first releases.
std::vector<TestUnit> joined_releases(const Parts& parts) {
  std::vector<TestUnit> units;
  std::map<std::size_t, std::size_t> unit_of_rock;
  for (std::size_t i = 0; i < parts.rocks.size(); ++i) {
    const std::size_t rock = parts.rocks[i];
    std::size_t unit = units.size();
    if (!parts.alone[i]) unit = unit_of_rock.emplace(rock, unit).first->second;
    if (unit == units.size()) units.emplace_back();
    TestUnit& own = units[unit];
    own.releases.push_back(static_cast<Index>(i));
    own.stratum.sites.insert(parts.sites[i]);
    if (parts.alone[i]) own.stratum.rock = rock + 1;
  }
  class_by_number(units);
  return units;
}

void set_strata(const std::vector<TestUnit>& list, SiteUnits& out) {
  std::map<Stratum, std::size_t> numbers;
  for (const TestUnit& unit : list) numbers.emplace(unit.stratum, 0);
  for (auto& [stratum, number] : numbers) number = out.strata++;
  for (const TestUnit& unit : list) out.units.strata.push_back(numbers.at(unit.stratum));
}

/// Takes the means of the sites away from the numbers and properties, and averages what is left over each unit.
SiteUnits means_of_units(const Releases& releases, const Parts& parts, const MatrixXd& properties) {
  SiteUnits out;
  out.blocks = releases.blocks.size();
  out.rocks = count_of(parts.rocks);
  out.sites = count_of(parts.sites);
  const std::vector<TestUnit> list = joined_releases(parts);
  set_strata(list, out);
  const VectorXd energy = within_strata(releases.energy, parts.sites);
  const MatrixXd x = within_strata(properties, parts.sites);
  out.energy.resize(std::ssize(list));
  out.x.resize(std::ssize(list), x.cols());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::vector<Index>& rows = list[i].releases;
    out.units.streams.push_back(releases.units.streams[static_cast<std::size_t>(rows.front())]);
    out.energy[static_cast<Index>(i)] = energy(rows).mean();
    out.x.row(static_cast<Index>(i)) = x(rows, Eigen::all).colwise().mean();
  }
  return out;
}

/// The rocks of a campaign.
SiteUnits units_of(const BlockNumbers& site) {
  const Releases releases(site.campaign, used_blocks(site.campaign, site.values), site.values);
  Parts parts{rocks_of(site.campaign, releases.blocks), releases.units.strata, {}};
  if (!groups_are_sites(parts.sites, parts.rocks)) parts.sites.assign(parts.sites.size(), 0);
  parts.alone.assign(parts.rocks.size(), false);
  return means_of_units(releases, parts, properties_of(site.campaign, releases.blocks));
}

/// A rock of one day is a unit. Of a rock of several days each release is one: its days change places within the rock
/// and the group.
Parts parts_of_days(const Campaign& campaign, const Releases& releases) {
  Parts parts{rocks_of(campaign, releases.blocks), releases.units.strata, {}};
  std::map<std::size_t, std::set<int>> days;
  for (std::size_t i = 0; i < parts.rocks.size(); ++i)
    days[parts.rocks[i]].insert(campaign.blocks[releases.blocks[i]].day);
  for (const std::size_t rock : parts.rocks) parts.alone.push_back(days.at(rock).size() > 1);
  return parts;
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
  const SiteUnits all = means_of_units(releases, parts_of_days(campaign, releases), x);
  test.by_rock = all.rocks < all.blocks;
  test.regression = regression_test(all.energy, all.x, all.units, rules.arrangements, seed);
  test.tested = test.regression.properties > 0;
  return test;
}

}  // namespace talus
