#include "talus/fit/diagnose/stability.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace talus {
namespace {

void widen(Interval& range, double p) {
  if (std::isnan(p)) return;
  range.low = std::isnan(range.low) ? p : std::min(range.low, p);
  range.high = std::isnan(range.high) ? p : std::max(range.high, p);
}

/// The different texts of the fits, the most frequent first; of equally frequent ones that of the earlier fit first.
std::vector<std::string> by_frequency(const Stability& stability, std::string BaseFitVerdict::*text) {
  std::vector<std::string> names;
  for (const BaseFitVerdict& fit : stability.fits)
    if (std::ranges::find(names, fit.*text) == names.end()) names.push_back(fit.*text);
  std::ranges::stable_sort(names, std::greater{},
                           [&](const std::string& name) { return std::ranges::count(stability.fits, name, text); });
  return names;
}

}  // namespace

std::vector<std::string> verdicts_of(const Stability& stability) {
  return by_frequency(stability, &BaseFitVerdict::effect);
}

std::string places_text(const Stability& stability) {
  const std::vector<std::string> places = by_frequency(stability, &BaseFitVerdict::where);
  if (verdicts_of(stability).size() != 1 || places.size() < 2) return {};
  std::string text;
  for (const std::string& place : places)
    text += (text.empty() ? "" : ", ") +
            std::to_string(std::ranges::count(stability.fits, place, &BaseFitVerdict::where)) + " of " +
            std::to_string(stability.fits.size()) + " " + place;
  return text;
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
