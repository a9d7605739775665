#include "talus/fit/diagnose/candidates.hpp"

#include <algorithm>
#include <set>

#include "instrument_bias.hpp"
#include "talus/fit/calibrate/effect_parameters.hpp"
#include "talus/fit/diagnose/undeclared_places.hpp"

namespace talus {
namespace {

constexpr std::size_t kMostZones = 256;  // numbers that a raster of bytes can hold

/// A place where an effect may act: everywhere, or one of the zones that the paths meet.
struct Place {
  std::string name;
  std::vector<std::uint8_t> zones;  // as EffectArea::zones
};

std::vector<Place> places_of(const Campaign& campaign, const Model& base, const std::vector<bool>& touched) {
  std::vector<Place> places{{"everywhere", {}}};
  if (std::count(touched.begin(), touched.end(), true) < 2) return places;
  for (std::size_t zone = 0; zone < touched.size(); ++zone) {
    if (!touched[zone]) continue;
    Place place{"zone " + campaign.zone_names[zone], std::vector<std::uint8_t>(base.grounds.size(), 0)};
    for (std::size_t i = zone; i < place.zones.size(); i += campaign.zone_names.size())
      place.zones[i] = 1;  // the copies of the zone in bands, too
    places.push_back(std::move(place));
  }
  return places;
}

/// An effect at a place, its numbers searched as the registry says.
Candidate candidate_of(const EffectEntry& entry, std::string where, const TypicalBlock& typical,
                       std::function<void(Model&)> place) {
  Candidate candidate{std::string(entry.name), std::move(where), {}, 0, {}};
  std::vector<std::pair<void (*)(Effects&, double), double>> settings;
  for (const EffectField& field : entry.fields()) {
    if (field.search) candidate.parameters.push_back(effect_parameter(entry, field, typical));
    if (field.search && field.is_strength()) ++candidate.tested;
    if (field.set_to != Typical::One) settings.emplace_back(field.set, typical.of(field.set_to));
  }
  candidate.prepare = [settings, place = std::move(place)](Model& m) {
    for (const auto& [set, value] : settings) set(m.effects, value);
    if (place) place(m);
  };
  return candidate;
}

Candidate on_days(const EffectEntry& entry, std::vector<int> days, const TypicalBlock& typical) {
  std::string where = days.size() > 1 ? "days" : "day";
  for (const int day : days) where += (day == days.front() ? " " : ", ") + std::to_string(day);
  Candidate candidate =
      candidate_of(entry, std::move(where), typical, [&entry, days](Model& m) { *entry.days(m.effects) = days; });
  candidate.searched = 1.0;
  candidate.days = std::move(days);
  return candidate;
}

/// The days of releases that are known, where there are several.
std::set<int> days_of(const Campaign& campaign) {
  std::set<int> days;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) days.insert(block.day);
  days.erase(0);  // not known
  return days.size() < 2 ? std::set<int>{} : days;
}

bool some_are_no_spheres(const Campaign& campaign) {
  return std::ranges::any_of(campaign.blocks,
                             [](const MeasuredBlock& b) { return !b.holdout && b.axes.x() > 1.05 * b.axes.z(); });
}

/// An effect at each place, in each variant or on each day where it may act.
void add_effect(std::vector<Candidate>& list, const EffectEntry& entry, const Campaign& campaign,
                const std::vector<Place>& places) {
  const TypicalBlock typical = typical_block(campaign);
  if (entry.sought == Sought::Everywhere) list.push_back(candidate_of(entry, "everywhere", typical, {}));
  if (entry.sought == Sought::InZones)
    for (const Place& place : places)
      list.push_back(candidate_of(entry, place.name, typical,
                                  [&entry, zones = place.zones](Model& m) { entry.area(m.effects)->zones = zones; }));
  if (entry.sought == Sought::OfShapes && some_are_no_spheres(campaign))
    for (const EffectField& field : entry.fields())
      for (const Variant& variant : field.variants)
        if (!variant.where.empty())
          list.push_back(candidate_of(entry, std::string(variant.where), typical,
                                      [set = field.set, value = variant.value](Model& m) { set(m.effects, value); }));
  if (entry.sought == Sought::OnDays)
    for (const int day : days_of(campaign)) list.push_back(on_days(entry, {day}, typical));
}

/// The effects of the registry that are sought, in the order of their turns.
std::vector<const EffectEntry*> sought_effects() {
  std::vector<const EffectEntry*> entries;
  for (const EffectEntry& entry : effect_entries())
    if (entry.sought != Sought::Nowhere) entries.push_back(&entry);
  std::ranges::stable_sort(entries, {}, &EffectEntry::turn);
  return entries;
}

/// Makes the priors so wide that the amount one would notice, at z = 1 until here, is at z = `noticed`.
void widen_priors(Candidate& candidate, double noticed) {
  for (Parameter& parameter : candidate.parameters) parameter.sd /= noticed;
}

}  // namespace

std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without, const DiagnosisRules& rules) {
  const std::vector<Place> places = places_of(campaign, base, touched_zones(campaign, runs));
  std::vector<Candidate> list;
  for (const EffectEntry* entry : sought_effects()) add_effect(list, *entry, campaign, places);
  add_biases(list, campaign);
  const Axis axis = axis_of(campaign, runs);
  const Grid& grid = campaign.surface.grid();
  const double width = grid.width() + grid.height(), length = axis.to - axis.from;
  for (int i = 0; i < rules.bands && base.grounds.size() <= kMostZones / 2; ++i)  // a band adds a copy of each
    list.push_back(
        band(campaign, axis, axis.from + length * i / rules.bands, axis.from + length * (i + 1) / rules.bands));
  for (int i = 1; i <= rules.barrier_places; ++i)
    list.push_back(barrier(axis, width, axis.from + length * i / (rules.barrier_places + 1)));
  std::erase_if(list, [&](const Candidate& c) { return std::ranges::find(without, c.effect) != without.end(); });
  for (Candidate& candidate : list) widen_priors(candidate, rules.noticed);
  return list;
}

std::vector<std::string> sought_names() {
  std::vector<std::string> names;
  for (const EffectEntry* entry : sought_effects()) names.emplace_back(entry->name);
  names.insert(names.end(), {"instrument-bias", "undeclared-zone", "undeclared-barrier"});
  return names;
}

Candidate merged_candidate(const Campaign& campaign, const Axis& axis, std::span<const Candidate> list,
                           std::span<const std::size_t> members, const DiagnosisRules& rules) {
  const Candidate &first = list[members.front()], &last = list[members.back()];
  const bool zone = first.effect == "undeclared-zone";
  if (!zone && first.days.empty()) return first;
  std::vector<int> days;
  for (const std::size_t member : members) days.insert(days.end(), list[member].days.begin(), list[member].days.end());
  Candidate merged = zone ? band(campaign, axis, first.from, last.to)
                          : on_days(*find_effect(first.effect), std::move(days), typical_block(campaign));
  widen_priors(merged, rules.noticed);
  return merged;
}

Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z) {
  Model model = base;
  candidate.prepare(model);
  return model_at(model, candidate.parameters, z);
}

}  // namespace talus
