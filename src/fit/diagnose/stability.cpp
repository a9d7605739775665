#include "talus/fit/diagnose/stability.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

void widen(Interval& range, double p) {
  if (std::isnan(p)) return;
  range.low = std::isnan(range.low) ? p : std::min(range.low, p);
  range.high = std::isnan(range.high) ? p : std::max(range.high, p);
}

}  // namespace

std::vector<std::string> verdicts_of(const Stability& stability) {
  std::vector<std::string> names;
  for (const BaseFitVerdict& fit : stability.fits)
    if (std::ranges::find(names, fit.effect) == names.end()) names.push_back(fit.effect);
  const auto count = [&](const std::string& name) {
    return std::ranges::count(stability.fits, name, &BaseFitVerdict::effect);
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return count(a) > count(b); });
  return names;
}

std::string undecided_text(const Stability& stability) {
  const std::vector<std::string> names = verdicts_of(stability);
  if (names.size() < 2) return {};
  std::string text = "undecided between " + names.front();
  for (std::size_t i = 1; i < names.size(); ++i) text += (i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

Interval p_range_of(const Stability& stability) {
  Interval range;
  for (const BaseFitVerdict& fit : stability.fits) widen(range, fit.p_value);
  return range;
}

Interval p_range_of(const Stability& stability, const std::string& family) {
  Interval range;
  for (const BaseFitVerdict& fit : stability.fits)
    for (const FamilyTest& test : fit.families)
      if (test.name == family) widen(range, test.p_value);
  return range;
}

}  // namespace talus
