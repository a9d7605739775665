#include "talus/products/screen_summary.hpp"

#include <algorithm>

#include "talus/base/sample.hpp"

namespace talus {
namespace {

double energy_of(const Crossing& c) {
  return kinetic_energy_kj(c.mass, c.speed);
}

double rotation_of(const Crossing& c) {
  return Block{c.diameter, c.mass}.rotational_energy_kj(c.spin);
}

constexpr std::array<ScreenQuantity, 8> kAll{{
    {"speed", "m/s", [](const Crossing& c) { return c.speed; }},
    {"energy", "kJ", energy_of},
    {"total energy", "kJ", [](const Crossing& c) { return energy_of(c) + rotation_of(c); }},
    {"jump height", "m", [](const Crossing& c) { return c.height; }},
    {"angular velocity", "rad/s", [](const Crossing& c) { return c.spin; }},
    {"dip", "deg", [](const Crossing& c) { return degrees(c.dip); }},
    {"incidence", "deg", [](const Crossing& c) { return degrees(c.incidence); }},
    {"place along", "m", [](const Crossing& c) { return c.along; }},
}};

}  // namespace

std::span<const ScreenQuantity> screen_quantities() {
  return kAll;
}

void ScreenSummary::add(std::span<const Crossing> crossings) {
  for (const Crossing& c : crossings) {
    One& one = screens_[c.screen];
    if (one.values[0].empty() || one.source != c.source || one.block != c.block) ++one.blocks;
    one.source = c.source;
    one.block = c.block;
    for (std::size_t q = 0; q < kQuantities; ++q) one.values[q].push_back(static_cast<float>(kAll[q].of(c)));
  }
}

ScreenSummary::Row ScreenSummary::row(std::size_t screen, std::size_t quantity) const {
  const One& one = screens_[screen];
  std::vector<double> sorted(one.values[quantity].begin(), one.values[quantity].end());
  if (sorted.empty()) return {0, 0, kNotGiven, kNotGiven, kNotGiven, kNotGiven, kNotGiven};
  std::sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  for (const double value : sorted) sum += value;
  return {sorted.size(),
          one.blocks,
          sum / static_cast<double>(sorted.size()),
          quantile(sorted, 0.50),
          quantile(sorted, 0.95),
          quantile(sorted, 0.99),
          sorted.back()};
}

}  // namespace talus
