#include "talus/fit/diagnose/undeclared_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/calibrate/amount.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/elementary.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

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
  for (const EffectEntry& entry : effect_entries())
    if (EffectArea* area = entry.area(m.effects)) twice(*area);
}

/// Multiplies a parameter of a ground, within the bounds of the files.
void multiply(Ground& ground, std::string_view key, double factor) {
  const auto fields = ground_fields();
  const auto field = std::ranges::find(fields, key, [](const auto& f) { return f.key; });
  field->set(ground, std::clamp(factor * field->get(ground), field->min, field->max));
}

}  // namespace

Candidate band(const Campaign& campaign, const Axis& axis, double from, double to) {
  const auto ratio = [](double Ground::*member) {
    return [member](const Model& m) {
      const std::size_t n = m.grounds.size() / 2;
      const double there = m.grounds[n].*member, beside = m.grounds[0].*member;
      return there > 0.0 && beside > 0.0 ? natural_log(there / beside) : kNotGiven;
    };
  };
  return {"undeclared-zone",
          std::to_string(std::lround(from)) + " to " + std::to_string(std::lround(to)) + " m",
          {amount(
               "undeclared-zone.damping", "1", {.lower = -3.0, .upper = 3.0, .noticed = 1.0},
               [=](const Model& m) { return -ratio(&Ground::En50)(m); },
               [](Model& m, double v) {
                 const std::size_t n = m.grounds.size() / 2;
                 for (std::size_t zone = 0; zone < n; ++zone) {
                   m.grounds[n + zone] = m.grounds[zone];
                   multiply(m.grounds[n + zone], "En50", exponential(-v));
                   multiply(m.grounds[n + zone], "Et50", exponential(-v));
                 }
               }),
           amount("undeclared-zone.roughness", "1", {.lower = -3.0, .upper = 3.0, .noticed = 0.7},
                  ratio(&Ground::theta_scale),
                  [](Model& m, double v) {
                    const std::size_t n = m.grounds.size() / 2;
                    for (std::size_t zone = 0; zone < n; ++zone) {
                      m.grounds[n + zone].theta_scale = m.grounds[zone].theta_scale;
                      multiply(m.grounds[n + zone], "theta_scale", exponential(v));
                    }
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
  return {"undeclared-barrier",
          "at " + std::to_string(std::lround(at)) + " m",
          {amount(
              "undeclared-barrier.height", "m", {.lower = 0.0, .upper = 10.0, .noticed = 1.0},
              [](const Model& m) { return m.barriers.back().height; },
              [](Model& m, double v) { m.barriers.back().height = v; })},
          1,
          [line](Model& m) {
            m.barriers.push_back({"undeclared-barrier", {line}, 0.0, std::numeric_limits<double>::infinity()});
          },
          1.0};
}

}  // namespace talus
