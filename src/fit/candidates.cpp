#include "talus/fit/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace talus {
namespace {

/// A parameter that is off at `off`, noticed at off + size, and searched on a linear scale.
Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                 std::function<double(const Model&)> get, std::function<void(Model&, double)> set) {
  return {std::move(key),  std::move(unit), lower,         upper, Parameter::Scale::Linear, off,
          size / kNoticed, std::move(get),  std::move(set)};
}

template <class Effect>
Parameter effect_amount(const char* key, const char* unit, double off, double size, double lower, double upper,
                        Effect Effects::*effect, double Effect::*member) {
  return amount(
      std::string("effects.") + key, unit, off, size, lower, upper,
      [=](const Model& m) { return m.effects.*effect.*member; },
      [=](Model& m, double v) { m.effects.*effect.*member = v; });
}

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
  std::vector<std::uint8_t> zones;  // as Extent::zones
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
                                  [](const MeasuredBlock& b) { return b.axes.x() > 1.05 * b.axes.z(); });
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

void add_days(std::vector<Candidate>& list, const Campaign& campaign) {
  std::set<int> days;
  for (const MeasuredBlock& block : campaign.blocks) days.insert(block.day);
  if (days.size() < 2) return;
  for (const int day : days)
    list.push_back(
        {"wet-ground",
         "day " + std::to_string(day),
         {effect_amount("wet-ground.softening", "1", 0.0, 0.7, 0.0, 4.0, &Effects::wet_ground, &WetGround::softening),
          effect_amount("wet-ground.drag", "1", 0.0, 0.7, 0.0, 4.0, &Effects::wet_ground, &WetGround::drag)},
         2,
         [day](Model& m) { m.effects.wet_ground.days = {day}; }});
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

void add_biases(std::vector<Candidate>& list, const Campaign& campaign) {
  const std::size_t instruments = campaign.screens.size() + 1;
  const auto add = [&](std::size_t which, const std::string& name, double Bias::*quantity, const char* what) {
    list.push_back({"instrument-bias",
                    name + " " + what,
                    {amount(
                        "instrument-bias." + name + "." + what, "1", 0.0, 0.15, -0.6, 1.5,
                        [=](const Model& m) { return m.bias.empty() ? 0.0 : m.bias[which].*quantity; },
                        [=](Model& m, double v) { m.bias[which].*quantity = v; })},
                    1,
                    [=](Model& m) { m.bias.resize(std::max(m.bias.size(), instruments)); }});
  };
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) {
    const auto crossed = std::count_if(campaign.blocks.begin(), campaign.blocks.end(),
                                       [s](const MeasuredBlock& b) { return b.passages[s].has_value(); });
    if (crossed < 5) continue;
    add(s, "screen " + campaign.screens[s].id, &Bias::speed, "speed");
    add(s, "screen " + campaign.screens[s].id, &Bias::jump, "jump");
    add(s, "screen " + campaign.screens[s].id, &Bias::spin, "spin");
  }
  const bool sampled = std::any_of(campaign.blocks.begin(), campaign.blocks.end(),
                                   [](const MeasuredBlock& b) { return !b.samples.empty(); });
  if (!sampled) return;
  add(campaign.screens.size(), "samples", &Bias::speed, "speed");
  add(campaign.screens.size(), "samples", &Bias::spin, "spin");
}

/// The zones with a band of other ground laid over them: each zone once more, in the band.
void lay_band(Model& m, const Campaign& campaign, const Axis& axis, double from, double to) {
  const Raster<std::uint8_t>& before = m.zones.values.empty() ? campaign.zones : m.zones;
  const Grid& grid = campaign.surface.grid();
  Raster<std::uint8_t> zones = before.values.empty() ? Raster<std::uint8_t>(grid, 0) : before;
  const auto shift = static_cast<std::uint8_t>(m.grounds.size());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double s = axis.along({(column + 0.5) * grid.cell_x, (row + 0.5) * grid.cell_y});
      if (s >= from && s < to) zones.at(column, row) = static_cast<std::uint8_t>(zones.at(column, row) + shift);
    }
  m.zones = std::move(zones);
  const std::size_t n = m.grounds.size();
  m.grounds.resize(2 * n);
  std::copy_n(m.grounds.begin(), n, m.grounds.begin() + static_cast<std::ptrdiff_t>(n));
  const auto twice = [n](Extent& where) {
    if (where.zones.empty()) return;
    where.zones.resize(2 * n);
    std::copy_n(where.zones.begin(), n, where.zones.begin() + static_cast<std::ptrdiff_t>(n));
  };
  Effects& e = m.effects;
  for (Extent* where : {&e.vegetation_drag.where, &e.forest_stems.where, &e.block_shape.where, &e.block_mass.where,
                        &e.wet_ground.where, &e.soft_ground.where, &e.rolling_resistance.where, &e.fragmentation.where})
    twice(*where);
}

}  // namespace

Axis axis_of(const Campaign& campaign, std::span<const BlockRuns> runs) {
  Eigen::Vector2d release = Eigen::Vector2d::Zero(), stop = release;
  double stops = 0.0;
  for (const MeasuredBlock& block : campaign.blocks) release += Eigen::Vector2d(block.x, block.y);
  release /= static_cast<double>(campaign.blocks.size());
  std::vector<Eigen::Vector2d> ends;
  for (const BlockRuns& r : runs)
    for (std::size_t t = 0; t < r.trials; ++t)
      if (!std::isnan(r.x[t])) ends.emplace_back(r.x[t], r.y[t]);
  for (const MeasuredBlock& block : campaign.blocks)
    if (block.stop) ends.push_back(*block.stop);
  for (const Eigen::Vector2d& end : ends) stop += end, stops += 1.0;
  Axis axis{release, Eigen::Vector2d::UnitX(), 0.0, 1.0};
  if (stops == 0.0 || (stop / stops - release).norm() == 0.0) return axis;
  axis.direction = (stop / stops - release).normalized();
  std::vector<double> reached;
  for (const Eigen::Vector2d& end : ends) reached.push_back(axis.along(end));
  std::sort(reached.begin(), reached.end());
  axis.to = std::max(1.0, quantile(reached, 0.95));
  return axis;
}

Candidate band(const Campaign& campaign, const Axis& axis, double from, double to) {
  const auto ratio = [](double Ground::*member) {
    return [member](const Model& m) {
      const std::size_t n = m.grounds.size() / 2;
      return std::log(m.grounds[n].*member / (m.grounds[0].*member));
    };
  };
  return {"undeclared-zone",
          std::to_string(std::lround(from)) + " to " + std::to_string(std::lround(to)) + " m",
          {amount(
               "undeclared-zone.damping", "1", 0.0, 1.0, -3.0, 3.0,
               [=](const Model& m) { return -ratio(&Ground::En50)(m); },
               [](Model& m, double v) {
                 const std::size_t n = m.grounds.size() / 2;
                 for (std::size_t zone = 0; zone < n; ++zone) {
                   m.grounds[n + zone] = m.grounds[zone];
                   m.grounds[n + zone].En50 *= std::exp(-v);
                   m.grounds[n + zone].Et50 *= std::exp(-v);
                 }
               }),
           amount("undeclared-zone.roughness", "1", 0.0, 0.7, -3.0, 3.0, ratio(&Ground::theta_scale),
                  [](Model& m, double v) {
                    const std::size_t n = m.grounds.size() / 2;
                    for (std::size_t zone = 0; zone < n; ++zone)
                      m.grounds[n + zone].theta_scale = m.grounds[zone].theta_scale * std::exp(v);
                  })},
          2,
          [&campaign, axis, from, to](Model& m) { lay_band(m, campaign, axis, from, to); },
          from,
          to};
}

Candidate barrier(const Axis& axis, double width, double at) {
  const Eigen::Vector2d middle = axis.origin + at * axis.direction;
  const Eigen::Vector2d across(-axis.direction.y(), axis.direction.x());
  const std::vector<Eigen::Vector2d> line{middle - width * across, middle + width * across};
  return {
      "undeclared-barrier",
      "at " + std::to_string(std::lround(at)) + " m",
      {amount(
          "undeclared-barrier.height", "m", 0.0, 1.0, 0.0, 10.0, [](const Model& m) { return m.nets.back().height; },
          [](Model& m, double v) { m.nets.back().height = v; })},
      1,
      [line](Model& m) {
        m.nets.push_back({line, 0.0, 1e9});
      }};
}

std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without) {
  const std::vector<Place> places = places_of(campaign, base, touched_zones(campaign, runs));
  const double mass = median_of(campaign, [](const MeasuredBlock& b) { return b.mass; });
  std::vector<Candidate> list;
  add_placed(list, places, "vegetation-drag", &Effects::vegetation_drag,
             {effect_amount("vegetation-drag.coefficient", "kg/s", 0.0, 0.1 * mass, 0.0, 3.0 * mass,
                            &Effects::vegetation_drag, &VegetationDrag::coefficient)});
  add_placed(list, places, "forest-stems", &Effects::forest_stems,
             {effect_amount("forest-stems.density", "1/ha", 0.0, 100.0, 0.0, 3000.0, &Effects::forest_stems,
                            &ForestStems::density)});
  add_placed(list, places, "soft-ground", &Effects::soft_ground,
             {effect_amount("soft-ground.drag", "1", 0.0, 1.0, 0.0, 20.0, &Effects::soft_ground, &SoftGround::drag)});
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
  for (int i = 0; i < kBands; ++i)
    list.push_back(band(campaign, axis, axis.from + length * i / kBands, axis.from + length * (i + 1) / kBands));
  for (int i = 1; i <= kLines; ++i) list.push_back(barrier(axis, width, axis.from + length * i / (kLines + 1)));
  std::erase_if(list, [&](const Candidate& c) { return std::ranges::find(without, c.effect) != without.end(); });
  return list;
}

Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z) {
  Model model = base;
  candidate.prepare(model);
  for (std::size_t i = 0; i < candidate.parameters.size(); ++i)
    candidate.parameters[i].set(model, candidate.parameters[i].value(z[static_cast<Eigen::Index>(i)]));
  return model;
}

}  // namespace talus
