#include "talus/products/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/bounds.hpp"
#include "talus/base/text.hpp"
#include "talus/products/hazard_table.hpp"
#include "talus/products/raster_table.hpp"

namespace talus {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool says(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

/// Whether a name is that of an entry with a number in the place of its placeholder.
bool is_named(const std::string& name, const std::string& entry, const std::string& placeholder) {
  if (placeholder.empty()) return name == entry;
  const std::string begin = entry.substr(0, entry.size() - placeholder.size());
  return name.starts_with(begin) && decimal_number(name.substr(begin.size()));
}

/// Where the first band of run `i` is worse than that of the other run, beyond the bounds of both.
bool is_surely_worse(const ComparedRaster& raster, std::span<const double> run, std::span<const double> other) {
  const auto bound = [&](double value) { return std::isnan(value) && raster.lower_is_worse ? kInfinite : value; };
  return raster.lower_is_worse ? bound(run[2]) < bound(other[1]) : run[1] > other[2];  // false with NaN
}

/// Calls `visit` with the values of each run in each cell.
template <class Visit>
void for_each_cell(const ComparedRaster& raster, std::span<const std::vector<double>> runs, Visit visit) {
  const std::size_t bands = raster.map.bands.size();
  std::vector<std::span<const double>> cell(runs.size());
  for (std::size_t first = 0; first < runs[0].size(); first += bands) {
    for (std::size_t run = 0; run < runs.size(); ++run) cell[run] = std::span(runs[run]).subspan(first, bands);
    visit(std::span<const std::span<const double>>(cell));
  }
}

/// Legend of the change: three classes to each side, those between the lowest limits without a colour.
Legend change_legend(const ComparedRaster& raster, const std::string& band) {
  Legend legend = raster.map.legend;
  const std::vector<double> above = raster.map.classes.empty()
                                        ? std::vector(legend.limits.begin(), legend.limits.begin() + 3)
                                        : std::vector{0.5, 1.5, 2.5};
  legend.limits = {-above[2], -above[1], -above[0], above[0], above[1], above[2]};
  legend.palette = raster.lower_is_worse ? Palette::ChangeReversed : Palette::Change;
  legend.band = band;
  legend.has_zero = legend.names_in_file = false;
  return legend;
}

}  // namespace

bool ComparedRaster::is_value(std::size_t band) const {
  const std::string& name = map.bands[band].name;
  return !says(name, "bound") && std::ranges::find(map.marks, name, &Map::Mark::band) == map.marks.end();
}

bool ComparedRaster::has_bounds() const {
  return map.bands.size() >= 3 && map.bands[1].name.ends_with("lower 95 % bound") &&
         map.bands[2].name.ends_with("upper 95 % bound");
}

std::size_t ComparedRaster::shown_band() const {
  const auto found = std::ranges::find(map.bands, map.legend.band, &Map::Band::name);
  return found == map.bands.end() ? 0 : static_cast<std::size_t>(found - map.bands.begin());
}

bool ComparedRaster::reached(std::span<const double> values) const {
  const double value = values[shown_band()];
  return zero_is_value ? !std::isnan(value) : value > 0.0;
}

std::optional<ComparedRaster> compared_raster(const std::string& name) {
  for (const RunRaster& raster : run_rasters())
    if (raster.map.name == name && raster.map.kind != Map::Kind::Count && raster.request != &RunCounts::bounds)
      return ComparedRaster{raster.map, false, raster.map.kind == Map::Kind::Quantity && !raster.untouched};
  for (const HazardRaster& raster : hazard_rasters()) {
    if (!is_named(name, raster.map.name, raster.placeholder)) continue;
    ComparedRaster found{raster.map, raster.map.smallest_in_overviews};
    found.map.name = name;
    return found;
  }
  return std::nullopt;
}

Map worst_map(const ComparedRaster& raster, std::size_t runs) {
  Map map = raster.map;
  map.name = (raster.lower_is_worse ? "lowest_" : "highest_") + map.name;
  map.title = (raster.lower_is_worse ? "Lowest of " : "Highest of ") + std::to_string(runs) + " runs: " + map.title;
  return map;
}

Map change_map(const ComparedRaster& raster) {
  Map map = raster.map;
  map.name = "change_" + map.name;
  map.title = "Change, run B minus run A: " + map.title;
  map.kind = Map::Kind::Quantity;
  map.smallest_in_overviews = false;
  map.farthest_in_overviews = true;
  map.marks.clear();
  map.bands.clear();
  for (std::size_t band = 0; band < raster.map.bands.size(); ++band)
    if (raster.is_value(band))
      map.bands.push_back({"change of " + raster.map.bands[band].name, raster.map.bands[band].unit});
  map.legend = change_legend(raster, "change of " + raster.map.bands[raster.shown_band()].name);
  if (!map.classes.empty())
    map.classes = {"3 or more classes lower", "2 classes lower",  "1 class lower",           "the same class",
                   "1 class higher",          "2 classes higher", "3 or more classes higher"};
  if (raster.has_bounds()) map.bands.push_back({"bounds apart", "1"});
  return map;
}

void take_worst(const ComparedRaster& raster, std::span<const std::vector<double>> runs, std::span<double> worst) {
  const std::size_t bands = raster.map.bands.size();
  for (std::size_t i = 0; i < worst.size(); ++i) {
    worst[i] = kNotGiven;
    for (const std::vector<double>& run : runs)  // fmin and fmax leave NaN out
      worst[i] = raster.lower_is_worse ? std::fmin(worst[i], run[i]) : std::fmax(worst[i], run[i]);
  }
  for (std::size_t band = 0; band < bands; ++band)
    if (raster.map.bands[band].name == "undecided")
      for (std::size_t first = 0; first < worst.size(); first += bands)
        if (!std::isnan(worst[first])) worst[first + band] = worst[first + 1] < worst[first + 2] ? 1.0 : 0.0;
}

void take_change(const ComparedRaster& raster, std::span<const std::vector<double>> runs, std::span<double> change) {
  auto to = change.begin();
  for_each_cell(raster, runs, [&](std::span<const std::span<const double>> cell) {
    for (std::size_t band = 0; band < raster.map.bands.size(); ++band) {
      if (!raster.is_value(band)) continue;
      const double a = cell[0][band], b = cell[1][band];
      const bool neither = std::isnan(a) && std::isnan(b), both = !std::isnan(a) && !std::isnan(b);
      const auto or_zero = [](double value) { return std::isnan(value) ? 0.0 : value; };
      *to++ = neither || (!raster.zero_is_value && !both) ? kNotGiven : or_zero(b) - or_zero(a);
    }
    if (!raster.has_bounds()) return;
    const bool apart = is_surely_worse(raster, cell[0], cell[1]) || is_surely_worse(raster, cell[1], cell[0]);
    const bool known = !std::isnan(cell[0][1]) && !std::isnan(cell[1][1]);
    *to++ = known ? (apart ? 1.0 : 0.0) : kNotGiven;
  });
}

void ComparedCells::add(const ComparedRaster& raster, std::span<const std::vector<double>> runs) {
  for_each_cell(raster, runs, [&](std::span<const std::span<const double>> cell) {
    const auto unknown = [&](std::span<const double> run) { return std::isnan(run[raster.shown_band()]); };
    if (!raster.zero_is_value && !raster.lower_is_worse && std::ranges::any_of(cell, unknown)) return;  // no terrain
    std::size_t many = 0, last = 0;
    for (std::size_t run = 0; run < cell.size(); ++run) {
      if (!raster.reached(cell[run])) continue;
      ++many;
      last = run;
    }
    if (many == 1) ++alone[last];
    if (many == cell.size()) {
      ++common;
      for (std::size_t run = 0; run < cell.size(); ++run) sum[run] += cell[run][raster.shown_band()];
    }
    if (cell.size() != 2 || !raster.has_bounds()) return;
    for (const std::size_t run : {std::size_t{0}, std::size_t{1}})
      if (is_surely_worse(raster, cell[run], cell[1 - run])) ++worse[run];
  });
}

double ComparedCells::mean(std::size_t run) const {
  return common == 0 ? kNotGiven : sum[run] / static_cast<double>(common);
}

}  // namespace talus
