#include "talus/fit/diagnose/families.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "talus/base/text.hpp"
#include "talus/fit/diagnose/corrected.hpp"
#include "talus/fit/diagnose/energy_component.hpp"
#include "talus/fit/score/holm.hpp"
#include "talus/physics/effects/registry.hpp"

namespace talus {
namespace {

constexpr const char *kProperty = "block property", *kPlace = "place", *kDay = "day", *kInstrument = "instrument",
                     *kDispersion = "dispersion";

std::string count_word(std::size_t n) {
  static constexpr std::array<const char*, 6> kWords{"no", "one", "two", "three", "four", "five"};
  return n < kWords.size() ? kWords[n] : std::to_string(n);
}

std::string rocks_word(std::size_t n) {
  return count_word(n) + (n == 1 ? " rock" : " rocks");
}

/// How the permutations were counted, for the reports.
std::string permutations_note(const PermutationTest& test, const std::string& what) {
  return std::string(test.exact ? "p from all " : "p from ") + std::to_string(test.arrangements) +
         " arrangements of the " + what;
}

/// A family that could not be significant, whichever of all arrangements was measured, names nothing.
void refuse_to_name(FamilyTest& family, const PermutationTest& test, double level) {
  if (!family.may_name || !test.exact || test.least <= level) return;
  family.may_name = false;
  family.note += ", of which the smallest p is " + with_digits(test.least, 2) + ": too few for any to be significant";
}

/// The units that the permutations exchanged in a test of a property, in words.
std::string units_word(const PropertyTest& test) {
  return std::string(test.by_rock ? "rocks" : "blocks") + (test.sites > 1 ? " within their sites" : "") +
         (test.by_rock ? ", not of their releases" : "");
}

/// A permutation test must be able to give as small a p as one by data sets.
DiagnosisRules rules_of(const FamilyOptions& options) {
  DiagnosisRules rules = options.rules;
  rules.arrangements = std::max(rules.arrangements, static_cast<std::size_t>(options.replicates));
  return rules;
}

/// A family with a test of its own.
FamilyTest family_with_members(const char* name, std::vector<std::string> members) {
  FamilyTest family;
  family.name = name;
  family.members = std::move(members);
  family.own_test = true;
  return family;
}

FamilyTest day(const FamilyInput& in, const std::vector<double>& energy, const FamilyOptions& options) {
  FamilyTest family = family_with_members(kDay, {"wet-ground"});
  const DayTest test = day_test(in.campaign, energy, rules_of(options), options.seed);
  if (!test.tested) {
    family.note = "releases of several days within one group are needed";
    return family;
  }
  family.p_value = test.regression.permuted.p_value;
  const char* units = test.by_rock ? "rocks within their groups, and of releases of one rock on several days"
                                   : "blocks within their groups";
  family.note = permutations_note(test.regression.permuted, units);
  refuse_to_name(family, test.regression.permuted, options.level);
  for (std::size_t i = 0; i < test.days.size(); ++i)
    family.parts.push_back({"day " + std::to_string(test.days[i]), "mean", test.means[i], kNotGiven});
  return family;
}

/// The most significant member, corrected within the family.
/// @param needed  note where nothing was measured that a member could change
FamilyTest by_score_test(const char* name, const char* needed, const FamilyInput& in) {
  FamilyTest family;
  family.name = name;
  std::vector<std::vector<double>> drawn;
  std::vector<double> measured;
  for (const EffectVerdict& effect : in.score_test.effects) {
    if (family_of(effect.effect) != name) continue;
    family.members.push_back(effect.effect);
    family.parts.push_back({effect.effect, "statistic", effect.best.statistic, effect.p_value});
    drawn.push_back(effect.drawn);
    measured.push_back(effect.best.p_value);
  }
  if (measured.empty()) {
    const bool had = std::ranges::any_of(in.found, [&](const std::string& e) { return family_of(e) == name; });
    family.note = had ? "its effects are in the model" : needed;
    return family;
  }
  family.p_value = corrected(drawn, measured).all;
  family.note = "p from " + std::to_string(drawn.front().size()) + " data sets drawn from the model";
  return family;
}

FamilyTest dispersion(const DispersionTest& test, const FamilyOptions& options) {
  FamilyTest family = family_with_members(kDispersion, {"rest-in-roughness"});
  if (!test.tested) {
    family.note = "at least ten blocks more than there are groups are needed";
    return family;
  }
  family.p_value = test.p_value;
  family.note = "p from " + std::to_string(options.replicates) +
                " data sets without an effect, of grounds that the measurements leave open";
  for (const DispersionRow& row : test.rows)
    family.parts.push_back({row.what, row.what.ends_with("P95") ? "share" : "variance", row.statistic, row.p_value});
  return family;
}

}  // namespace

std::string family_of(const std::string& effect) {
  if (effect == "instrument-bias") return kInstrument;
  if (effect == "block-mass") return kProperty;
  const EffectEntry* entry = find_effect(effect);
  if (entry != nullptr && entry->sought == Sought::OfShapes) return kProperty;
  if (entry != nullptr && entry->sought == Sought::OnDays) return kDay;
  return kPlace;
}

std::vector<FamilyTest> test_families(const FamilyInput& input, const FamilyOptions& options) {
  const std::vector<double> energy = energy_by_block(input.space, input.runs, input.rows);
  const std::vector<BlockNumbers> site{{input.campaign, energy}};
  std::vector<FamilyTest> families{
      test_block_property(site, options), by_score_test(kPlace, "measured values are needed", input),
      day(input, energy, options),
      by_score_test(kInstrument, "a screen that five blocks crossed, or samples, are needed", input),
      dispersion(input.score_test.dispersion, options)};
  std::vector<FamilyTest*> all;
  for (FamilyTest& family : families) all.push_back(&family);
  correct(all);
  return families;
}

std::vector<double> energy_by_block(const ResidualSpace& space, const std::vector<BlockRuns>& runs,
                                    const std::vector<bool>& rows) {
  const EnergyComponent component(space, runs);
  std::vector<double> energy(rows.size(), kNotGiven);
  for (std::size_t b = 0; b < energy.size(); ++b)
    if (rows[b] && runs[b].trials > 0) energy[b] = component.of_measured(b);
  return energy;
}

FamilyTest test_block_property(std::span<const BlockNumbers> sites, const FamilyOptions& options) {
  FamilyTest family = family_with_members(kProperty, {"block-shape", "block-mass"});
  const PropertyTest test = property_test(sites, rules_of(options), options.seed);
  family.may_name = test.rocks >= options.rules.fewest_rocks;
  if (!family.may_name) family.note = rocks_word(test.rocks) + ": a property of the block cannot be named from them";
  if (!test.tested) {
    if (family.may_name)
      family.note = test.blocks < options.rules.fewest_blocks ? "ten blocks and more are needed"
                                                              : "two rocks that can be compared are needed";
    return family;
  }
  const PermutationTest& permuted = test.regression.permuted;
  family.p_value = permuted.p_value;
  family.note += (family.may_name ? "" : "; ") + permutations_note(permuted, units_word(test));
  refuse_to_name(family, permuted, options.level);
  for (std::size_t i = 0; i < test.slopes.size(); ++i)
    if (!std::isnan(test.slopes[i].correlation))
      family.parts.push_back(
          {test.names[i], "partial correlation", test.slopes[i].correlation, test.slopes[i].p_value});
  return family;
}

void correct(std::span<FamilyTest* const> families) {
  std::vector<double> p_values;
  for (const FamilyTest* family : families)  // a test that can name nothing takes no part of the level
    p_values.push_back(family->may_name ? family->p_value : kNotGiven);
  const std::vector<double> after = holm(p_values);
  for (std::size_t i = 0; i < families.size(); ++i) families[i]->p_corrected = after[i];
}

bool can_be_named(std::span<const FamilyTest> families, const std::string& effect) {
  return std::ranges::any_of(families, [&](const FamilyTest& family) {
    return family.may_name && !std::isnan(family.p_value) &&
           std::ranges::find(family.members, effect) != family.members.end();
  });
}

double smallest_corrected(std::span<const FamilyTest> families) {
  double smallest = 1.0;
  for (const FamilyTest& family : families)
    if (family.p_corrected < smallest) smallest = family.p_corrected;
  return smallest;
}

const FamilyTest* admitting(std::span<const FamilyTest> families, const std::string& effect, double level) {
  const FamilyTest* found = nullptr;
  for (const FamilyTest& family : families)
    if (family.may_name && family.p_corrected <= level &&
        std::ranges::find(family.members, effect) != family.members.end() && (found == nullptr || family.own_test))
      found = &family;
  return found;
}

}  // namespace talus
