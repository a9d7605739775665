#include "talus/fit/diagnose/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "anomalies.hpp"
#include "talus/base/sample.hpp"

namespace talus {
namespace {

template <class Effect>
Parameter effect_amount(const char* key, const char* unit, double off, double size, double lower, double upper,
                        Effect Effects::*effect, double Effect::*member) {
  return amount(
      std::string("effects.") + key, unit, off, size, lower, upper,
      [=](const Model& m) { return m.effects.*effect.*member; },
      [=](Model& m, double v) { m.effects.*effect.*member = v; });
}

constexpr std::size_t kMostZones = 256;  // that a raster of bytes can tell apart

double median_of(const Campaign& campaign, const std::function<double(const MeasuredBlock&)>& value) {
  std::vector<double> values;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) values.push_back(value(block));
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

/// Where an effect that has an extent may act: everywhere, or in one of the zones that the paths meet.
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
      place.zones[i] = 1;  // and bands
    places.push_back(std::move(place));
  }
  return places;
}

/// Effects that act in a zone.
template <class Effect>
void add_placed(std::vector<Candidate>& list, const std::vector<Place>& places, const char* name,
                Effect Effects::*effect, const std::vector<Parameter>& parameters) {
  for (const Place& place : places)
    list.push_back({name, place.name, parameters, parameters.size(),
                    [effect, zones = place.zones](Model& m) { (m.effects.*effect).where.zones = zones; }});
}

void add_shape_and_mass(std::vector<Candidate>& list, const Campaign& campaign) {
  const bool shaped = std::any_of(campaign.blocks.begin(), campaign.blocks.end(),
                                  [](const MeasuredBlock& b) { return !b.holdout && b.axes.x() > 1.05 * b.axes.z(); });
  for (const double elongation : shaped ? std::vector<double>{0.0, 1.0} : std::vector<double>{})
    list.push_back(
        {"block-shape",
         elongation > 0.0 ? "by L1/L2" : "by L1/L3",
         {effect_amount("block-shape.lateral", "1", 0.0, 0.5, 0.0, 6.0, &Effects::block_shape, &BlockShape::lateral),
          effect_amount("block-shape.loss", "1", 0.0, 0.1, 0.0, 2.0, &Effects::block_shape, &BlockShape::loss)},
         2,
         [elongation](Model& m) { m.effects.block_shape.elongation = elongation; }});
  const double reference =
      median_of(campaign, [](const MeasuredBlock& b) { return equivalent_diameter(b.mass, b.density); });
  list.push_back(
      {"block-mass",
       "everywhere",
       {effect_amount("block-mass.roughness", "1", 0.0, 0.4, -2.0, 2.0, &Effects::block_mass, &BlockMass::roughness),
        effect_amount("block-mass.stiffness", "1", 0.0, 0.8, -3.0, 3.0, &Effects::block_mass, &BlockMass::stiffness)},
       2,
       [reference](Model& m) { m.effects.block_mass.reference_diameter = reference; }});
}

Candidate wet_on(std::vector<int> days) {
  std::string where = days.size() > 1 ? "days" : "day";
  for (const int day : days) where += (day == days.front() ? " " : ", ") + std::to_string(day);
  Candidate candidate{
      "wet-ground",
      std::move(where),
      {effect_amount("wet-ground.softening", "1", 0.0, 0.7, 0.0, 4.0, &Effects::wet_ground, &WetGround::softening),
       effect_amount("wet-ground.drag", "1", 0.0, 0.7, 0.0, 4.0, &Effects::wet_ground, &WetGround::drag)},
      2,
      [days](Model& m) { m.effects.wet_ground.days = days; },
      1.0};
  candidate.days = std::move(days);
  return candidate;
}

void add_days(std::vector<Candidate>& list, const Campaign& campaign) {
  std::set<int> days;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) days.insert(block.day);
  days.erase(0);  // not known
  if (days.size() < 2) return;
  for (const int day : days) list.push_back(wet_on({day}));
}

void add_fragmentation(std::vector<Candidate>& list) {
  list.push_back({"fragmentation",
                  "everywhere",
                  {amount(
                       "effects.fragmentation.1/threshold", "kg/J", 0.0, 0.02, 0.0, 0.5,
                       [](const Model& m) {
                         const double threshold = m.effects.fragmentation.threshold;
                         return threshold > 0.0 ? 1.0 / threshold : 0.0;
                       },
                       [](Model& m, double v) { m.effects.fragmentation.threshold = v > 0.0 ? 1.0 / v : 0.0; }),
                   effect_amount("fragmentation.largest", "1", 0.7, 0.15, 0.5, 0.99, &Effects::fragmentation,
                                 &Fragmentation::largest)},
                  1,
                  [](Model&) {}});
}

/// Makes the priors so wide that the amount one would notice, at z = 1 until here, is at z = `noticed`.
void widen_priors(Candidate& candidate, double noticed) {
  for (Parameter& parameter : candidate.parameters) parameter.sd /= noticed;
}

}  // namespace

std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without, const DiagnosisRules& rules) {
  const std::vector<Place> places = places_of(campaign, base, touched_zones(campaign, runs));
  const double mass = median_of(campaign, [](const MeasuredBlock& b) { return b.mass; });
  std::vector<Candidate> list;
  add_placed(list, places, "vegetation-drag", &Effects::vegetation_drag,
             {effect_amount("vegetation-drag.coefficient", "kg/s", 0.0, 0.1 * mass, 0.0, 3.0 * mass,
                            &Effects::vegetation_drag, &VegetationDrag::coefficient)});
  add_placed(list, places, "forest-stems", &Effects::forest_stems,
             {effect_amount("forest-stems.density", "1/ha", 0.0, 100.0, 0.0, 3000.0, &Effects::forest_stems,
                            &ForestStems::density)});
  // M_E stays at 15 MN/m2: soil of 2 MN/m2, with a deeper scar, is as a drag five times larger.
  add_placed(list, places, "soft-ground", &Effects::soft_ground,
             {effect_amount("soft-ground.drag", "1", 0.0, 4.0, 0.0, 100.0, &Effects::soft_ground, &SoftGround::drag)});
  add_placed(list, places, "rolling-resistance", &Effects::rolling_resistance,
             {effect_amount("rolling-resistance.coefficient", "1", 0.0, 0.2, 0.0, 2.0, &Effects::rolling_resistance,
                            &RollingResistance::coefficient)});
  list.push_back(
      {"air-drag",
       "everywhere",
       {effect_amount("air-drag.coefficient", "1", 0.0, 1.0, 0.0, 5.0, &Effects::air_drag, &AirDrag::coefficient)},
       1,
       [](Model&) {}});
  add_shape_and_mass(list, campaign);
  add_days(list, campaign);
  add_fragmentation(list);
  add_biases(list, campaign);
  const Axis axis = axis_of(campaign, runs);
  const Grid& grid = campaign.surface.grid();
  const double width = grid.columns * grid.cell_x + grid.rows * grid.cell_y, length = axis.to - axis.from;
  for (int i = 0; i < rules.bands && base.grounds.size() <= kMostZones / 2; ++i)  // a band repeats them
    list.push_back(
        band(campaign, axis, axis.from + length * i / rules.bands, axis.from + length * (i + 1) / rules.bands));
  for (int i = 1; i <= rules.barrier_places; ++i)
    list.push_back(barrier(axis, width, axis.from + length * i / (rules.barrier_places + 1)));
  std::erase_if(list, [&](const Candidate& c) { return std::ranges::find(without, c.effect) != without.end(); });
  for (Candidate& candidate : list) widen_priors(candidate, rules.noticed);
  return list;
}

Candidate merged_candidate(const Campaign& campaign, const Axis& axis, std::span<const Candidate> list,
                           std::span<const std::size_t> members, const DiagnosisRules& rules) {
  const Candidate &first = list[members.front()], &last = list[members.back()];
  const bool zone = first.effect == "undeclared-zone";
  if (!zone && first.effect != "wet-ground") return first;
  std::vector<int> days;
  for (const std::size_t member : members) days.insert(days.end(), list[member].days.begin(), list[member].days.end());
  Candidate merged = zone ? band(campaign, axis, first.from, last.to) : wet_on(std::move(days));
  widen_priors(merged, rules.noticed);
  return merged;
}

Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z) {
  Model model = base;
  candidate.prepare(model);
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
    candidate.parameters[i].set(model, candidate.parameters[i].value(z[static_cast<Eigen::Index>(i)]));
  return model;
}

}  // namespace talus
