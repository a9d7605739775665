#include "fitted_on.hpp"

#include <algorithm>
#include <cmath>

#include "surface_key.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {
namespace {

constexpr double kOtherCells = 1.5;  // ratio of two sizes of cells; from 0.5 to 1 m the run-out changed by 1 %

constexpr Bounds kFittedCell{"fitted_cell", "m",    "side of the cells of the DEM on which a model was fitted",
                             0.0,           1000.0, Bounds::AboveMin};
constexpr Bounds kFittedDiameters{"fitted_diameters", "m", "of the blocks to which a model was fitted", 0.0, 1000.0,
                                  Bounds::AboveMin};
constexpr Bounds kFittedSkill{"fitted_skill", "1", "share by which the error is below that of the climatology", -1e9,
                              1e9};

constexpr const char* kNoSkill = "the fit has no skill";

bool has_ground(const ScenarioSpec& spec, const std::string& name) {
  return spec.default_ground.name == name || std::ranges::count(spec.zones, name, &ZoneSpec::name) > 0;
}

bool is_number_of_ground(const TomlValue& item) {
  return item.kind == TomlValue::Kind::Text &&
         (item.text == "shape" ||
          std::ranges::any_of(ground_fields(), [&](const auto& field) { return field.key == item.text; }));
}

/// [fit.zones]: the keys of each ground that are of the model. A name that no ground has would end its warnings.
void read_numbers(ScenarioSpec& spec, TableReader zones) {
  if (zones.value() == nullptr) return;
  for (const auto& [name, value] : zones.value()->members) {
    if (!has_ground(spec, name)) {
      zones.fault(name, value,
                  "must be a ground of this scenario: rename it here as in [ground.zones], or leave it out");
      continue;
    }
    if (value.kind != TomlValue::Kind::List || !std::ranges::all_of(value.items, is_number_of_ground)) {
      zones.fault(name, value, "must be a list of keys of a ground, like [\"theta_scale\"]");
      continue;
    }
    for (const TomlValue& item : value.items) spec.fitted_on.numbers[name].push_back(item.text);
  }
}

}  // namespace

void read_fitted(TableReader& table, FittedOn& fitted) {
  fitted.cell = table.number("fitted_cell", kFittedCell);
  fitted.diameters = table.range("fitted_diameters", kFittedDiameters);
  const auto skill = table.numbers("fitted_skill", kFittedSkill);
  if (!skill) return;
  fitted.skill = skill_of_list(*skill);
  if (!fitted.skill) table.fault("fitted_skill", *table.find("fitted_skill"), "must be [value, low, high], or [value]");
}

void read_fit(ScenarioSpec& spec, TableReader table, const std::filesystem::path& base) {
  if (table.value() == nullptr) return;
  const std::string here = table.file() + ":" + std::to_string(table.value()->line) + ": [fit]";
  if (!spec.include.path.empty())
    table.faults().push_back(here + ": is of the model of an earlier run, must not come with include: leave out one");
  FittedOn& fitted = spec.fitted_on;
  auto file = table.named_file("file", base);
  if (table.find("file") == nullptr)
    table.faults().push_back(here + ": names no file, must have file = \"...\", the fitted model");
  fitted.file = std::move(file).value_or(NamedFile{});
  fitted.sha256 = table.text("sha256").value_or("");
  fitted.surface = read_surface(table);
  read_fitted(table, fitted);
  const auto& fields = scenario_fields();
  const auto c = std::ranges::find(fields, "model.deformation_coefficient", [](const auto& f) { return f.key; });
  fitted.deformation_coefficient = table.number("deformation_coefficient", *c);
  read_numbers(spec, table.table("zones"));
  table.finish();
  spec.origins["fit"] = "scenario";
}

std::string reduction_in_words(const Reduction& reduction) {
  const auto tenths = [](double share) { return with_decimals(100.0 * share, 1); };
  const Interval& interval = reduction.interval;
  return tenths(reduction.share) + " %" +
         (std::isnan(interval.low) ? "" : " (95 %: " + tenths(interval.low) + " to " + tenths(interval.high) + " %)");
}

std::optional<Reduction> skill_of_list(std::span<const double> list) {
  if (list.size() == 1) return Reduction{list[0], {}};
  if (list.size() == 3 && list[1] <= list[0] && list[0] <= list[2]) return Reduction{list[0], {list[1], list[2]}};
  return std::nullopt;
}

std::string skill_list(const Reduction& skill) {
  const auto rounded = [](double share) { return std::round(1e4 * share) / 1e4; };
  if (std::isnan(skill.interval.low)) return list_text({rounded(skill.share)});
  return list_text({rounded(skill.share), rounded(skill.interval.low), rounded(skill.interval.high)});
}

void warn_of_other_terrain(const ScenarioSpec& spec, const Grid& grid, SurfaceKind kind, const std::string& where,
                           const std::string& used, const std::string& remedy, std::vector<std::string>& warnings) {
  const FittedOn& on = spec.fitted_on;
  if (on.surface && *on.surface != kind)
    warnings.push_back(where + ": " + kOtherTerrain + " a " + std::string(name_of(*on.surface)) + " surface, and " +
                       used + " on a " + std::string(name_of(kind)) + " one" + remedy);
  if (!on.cell) return;
  const double fitted = *on.cell, here = grid.cell_x;
  if (std::max(fitted, here) < kOtherCells * std::min(fitted, here)) return;
  warnings.push_back(where + ": " + kOtherTerrain + " cells of " + with_digits(fitted, 3) + " m, and " + used +
                     " on cells of " + with_digits(here, 3) +
                     " m: where the ground is uneven, coarser cells carry the same blocks " +
                     "farther: take a DEM of like cells, or fit again");
}

bool is_of_fit(const ScenarioSpec& spec, const ZoneSpec& zone, const std::string& key) {
  const auto own = zone.own.find(key);
  if (own == zone.own.end()) return false;
  if (own->second != "scenario") return true;  // of the included model
  const auto keys = spec.fitted_on.numbers.find(zone.name);
  return keys != spec.fitted_on.numbers.end() && std::ranges::count(keys->second, key) > 0;
}

bool uses_fit(const ScenarioSpec& spec) {
  const auto of_fit = [&spec](const ZoneSpec& zone) {
    return std::ranges::any_of(zone.own, [&](const auto& number) { return is_of_fit(spec, zone, number.first); });
  };
  return of_fit(spec.default_ground) || std::ranges::any_of(spec.zones, of_fit);
}

bool says_fit_does_not_hold(const std::string& warning) {
  return std::ranges::any_of(std::initializer_list<const char*>{kNoSkill, kOtherTerrain, kOtherCoefficient},
                             [&](const char* words) { return warning.find(words) != warning.npos; });
}

void warn_of_no_skill(const ScenarioSpec& spec, std::vector<std::string>& warnings) {
  const std::optional<Reduction>& skill = spec.fitted_on.skill;
  if (!skill || skill->share > 0.0 || !uses_fit(spec)) return;
  warnings.push_back(spec.fitted_on.file.where + ": " + kNoSkill + ": " + reduction_in_words(*skill) +
                     ": the measurements of its campaign, without any model, tell as well or better where its blocks "
                     "go: do not use it (unsafe); see the report of the fit beside it");
}

void warn_of_other_coefficient(const ScenarioSpec& spec, std::vector<std::string>& warnings) {
  const std::optional<double>& fitted = spec.fitted_on.deformation_coefficient;
  const double here = spec.values.impact.deformation_coefficient;
  if (!fitted || here == *fitted || !uses_fit(spec)) return;
  warnings.push_back(spec.fitted_on.file.where + ": " + kOtherCoefficient + " c = " + text_of(*fitted) +
                     ", and this run takes " + text_of(here) + " (" + spec.origin("model.deformation_coefficient") +
                     "): a fitted ground holds only for the c of its fit: fit it again with this c, in [model] of the "
                     "model from which the fit starts (--parameters)");
}

}  // namespace talus::io
