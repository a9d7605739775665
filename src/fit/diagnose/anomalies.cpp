#include "anomalies.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

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
  const auto twice = [n](EffectArea& where) {
    if (where.zones.empty()) return;
    where.zones.resize(2 * n);
    std::copy_n(where.zones.begin(), n, where.zones.begin() + static_cast<std::ptrdiff_t>(n));
  };
  Effects& e = m.effects;
  for (EffectArea* where :
       {&e.vegetation_drag.where, &e.forest_stems.where, &e.block_shape.where, &e.block_mass.where, &e.wet_ground.where,
        &e.soft_ground.where, &e.rolling_resistance.where, &e.fragmentation.where})
    twice(*where);
}

}  // namespace

Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                 std::function<double(const Model&)> get, std::function<void(Model&, double)> set) {
  return {std::move(key), std::move(unit), lower,         upper, Parameter::Scale::Linear, off,
          size,           std::move(get),  std::move(set)};
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
                                       [s](const MeasuredBlock& b) { return !b.holdout && b.passages[s].has_value(); });
    if (crossed < 5) continue;
    add(s, "screen " + campaign.screens[s].id, &Bias::speed, "speed");
    add(s, "screen " + campaign.screens[s].id, &Bias::jump, "jump");
    add(s, "screen " + campaign.screens[s].id, &Bias::spin, "spin");
  }
  const bool sampled = std::any_of(campaign.blocks.begin(), campaign.blocks.end(),
                                   [](const MeasuredBlock& b) { return !b.holdout && !b.samples.empty(); });
  if (!sampled) return;
  add(campaign.screens.size(), "samples", &Bias::speed, "speed");
  add(campaign.screens.size(), "samples", &Bias::spin, "spin");
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
          2.0,
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
      },
      1.0};
}

}  // namespace talus
