#pragma once
#include <span>

#include "talus/fit/campaign/campaign.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"
#include "talus/fit/diagnose/regression.hpp"

namespace talus {

/// Test whether a number per block depends on the block: its shape, its mass.
struct PropertyTest {
  bool tested = false;  ///< false: too few blocks, or all are alike
  RegressionTest regression;
  std::vector<std::string> names;          ///< of the properties: "log L1/L2", "log L1/L3", "log mass"
  std::vector<PartialCorrelation> slopes;  ///< by property
  std::size_t blocks = 0, rocks = 0, sites = 0;
  bool by_rock = false;  ///< a rock was released twice: rocks change places, not their releases
};

/// Regresses `energy` on log L1/L2, log L1/L3 and log mass with an intercept for each site. Groups are sites where
/// different rocks were released in one of them; where each group is one rock, its intercept would take all that a rock
/// can show, and there is one intercept for all. The unit is the rock (docs/diagnosis-method.md, "Rocks"), with the
/// means of its releases; it changes places with rocks that were released at the same sites, and about as often.
///
/// @param energy  by block of the campaign (EnergyComponent); NaN: not used
PropertyTest property_test(const Campaign& campaign, const std::vector<double>& energy, const DiagnosisRules& rules,
                           std::uint64_t seed);

/// A number for each block of a campaign; NaN: not used. The parts must outlive it.
struct BlockNumbers {
  const Campaign& campaign;
  const std::vector<double>& values;
};

/// The same for the blocks of several campaigns together, each with intercepts of its own: blocks of different
/// campaigns never change places. A rock is one unit in its own campaign.
PropertyTest property_test(std::span<const BlockNumbers> sites, const DiagnosisRules& rules, std::uint64_t seed);

/// Test whether a number per block depends on the day of release.
struct DayTest {
  bool tested = false;  ///< false: fewer than two days, or none with others in the same group
  RegressionTest regression;
  std::vector<int> days;
  std::vector<double> means;  ///< by day: of the energy, without the means of the groups
  std::size_t blocks = 0;
  bool by_rock = false;  ///< a rock was released twice
};

/// The factor of the day, with an intercept for each group, permuted within groups. Releases of one rock are not
/// independent: a rock of one day is one unit, with the mean of its releases, which changes places with rocks that were
/// released in the same groups and about as often; the days of a rock of several days change places within the rock.
DayTest day_test(const Campaign& campaign, const std::vector<double>& energy, const DiagnosisRules& rules,
                 std::uint64_t seed);

}  // namespace talus
