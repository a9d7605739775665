#include "profile_keys.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "effect_keys.hpp"
#include "file_kind.hpp"
#include "ground_keys.hpp"
#include "scenario_flags.hpp"
#include "scenario_keys.hpp"
#include "surface_key.hpp"
#include "table_reader.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

constexpr Bounds kBin{"bin", "m", "width of the bins of the results", 0.05, 1000.0},
    kPlaceAlong{"x", "m", "place along the profile", -1e7, 1e7};

/// A number that a list holds twice.
std::optional<double> repeated(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const auto twice = std::ranges::adjacent_find(numbers);
  return twice == numbers.end() ? std::nullopt : std::optional(*twice);
}

/// Reads the keys that only a profile has.
class ProfileReader {
 public:
  ProfileReader(ScenarioSpec& spec, const std::string& file, std::vector<std::string>& faults)
      : spec_(spec), profile_(*spec.profile), faults_(faults), base_(std::filesystem::absolute(file).parent_path()) {}

  void read(TableReader top) {
    named_file(top, "profile", profile_.csv);
    named_file(top, "dem", spec_.dem);
    named_file(top, "line", profile_.line);
    if (const auto kind = read_surface(top)) {
      spec_.surface = *kind;
      given("surface");
    }
    number(top, "step", kProfileStep, profile_.step);
    read_common_keys(spec_, top, faults_);
    read_sources(top.table("sources"));
    TableReader ground = top.table("ground");
    GroundReader(spec_, "scenario", faults_).read_on_profile(ground);
    ground.finish();
    read_output(top.table("output"));
    TableReader screens = top.table("screens");
    read_screens(screens);
    screens.finish();
    top.finish();
  }

 private:
  void given(const std::string& key) { spec_.origins[key] = "scenario"; }

  /// A key that is there is given, also where its value is a fault: nobody shall then read that it is missing.
  void given_if_there(TableReader& table, const std::string& key) {
    if (table.find(key) != nullptr) given(table.full(key));
  }

  void named_file(TableReader& table, const std::string& key, NamedFile& file) {
    given_if_there(table, key);
    if (auto named = table.named_file(key, base_)) file = std::move(*named);
  }

  void number(TableReader& table, const std::string& key, const Bounds& bounds, double& out) {
    if (const auto value = table.number(key, bounds)) {
      out = *value;
      given(table.full(key));
    }
  }

  void read_sources(TableReader table) {
    given_if_there(table, "x");
    if (const auto x = table.range("x", kPlaceAlong)) profile_.source = *x;
    if (const auto range = table.range("release_height", bounds_of("sources.release_height"))) {
      spec_.release_height = *range;
      given("sources.release_height");
    }
    number(table, "vx", bounds_of("sources.velocity"), profile_.vx);
    number(table, "vz", bounds_of("sources.velocity"), profile_.vz);
    table.finish();
  }

  void read_screens(TableReader& table) {
    auto x = table.numbers("x", kPlaceAlong);
    if (!x) return;
    profile_.screens = *x;
    given("screens.x");
    if (const auto twice = repeated(*x))
      table.fault("x", *table.find("x"), "has " + text_of(*twice) + " twice, must name each place once");
  }

  void read_output(TableReader table) {
    for (const auto& field : scenario_fields())
      if (field.key == "output.trajectories")
        if (const auto value = table.number("trajectories", field)) {
          field.set(spec_.values, *value);
          given("output.trajectories");
        }
    number(table, "bin", kBin, profile_.bin);
    const double columns = profile_.bin / profile_.step;
    if (columns < 0.5 || std::abs(columns - std::round(columns)) > 1e-6)
      faults_.push_back(table.file() + ": output.bin = " + text_of(profile_.bin) +
                        ": must be a whole multiple of step = " + text_of(profile_.step) + " m");
    table.finish();
  }

  ScenarioSpec& spec_;
  ProfileSpec& profile_;
  std::vector<std::string>& faults_;
  std::filesystem::path base_;
};

/// Adds a fault for an effect that turns a block out of the plane, and for polygons.
void check_effects(const ScenarioSpec& spec, std::vector<std::string>& faults) {
  for (const auto& [name, effect] : spec.effects) {
    if (find_effect(name)->leaves_plane)
      faults.push_back(effect.where + ": leads blocks out of the plane of the profile, must be left out here");
    if (!effect.file.path.empty())
      faults.push_back(effect.file.where + ": there are no polygons on a profile, must be zones");
  }
}

/// Removes the sideways roughness of a preset. Adds a fault if the file gives one.
void flatten(ZoneSpec& zone, const std::string& table, std::vector<std::string>& faults) {
  const auto own = zone.own.find("psi_scale");
  if (own != zone.own.end() && zone.ground.psi_scale != 0.0)
    faults.push_back(table + ".psi_scale = " + text_of(zone.ground.psi_scale) +
                     ": a profile has no sideways roughness, must be 0 or left out");
  zone.ground.psi_scale = 0.0;
}

/// Adds a fault for a number of a flag that is out of bounds.
void check_flag(const std::string& flag, double value, const Bounds& bounds, std::vector<std::string>& faults) {
  if (const auto rule = fault_of(bounds, value)) faults.push_back(flag + " = " + text_of(value) + ": " + *rule);
}

/// The flags that only a profile has, in place of its file's settings.
void lay_profile_flags(ScenarioSpec& spec, const ProfileFlags& flags, std::vector<std::string>& faults) {
  ProfileSpec& profile = *spec.profile;
  if (flags.line) {
    const std::string flag = "flag --line";
    profile.line = {absolute_path(*flags.line, std::filesystem::current_path()), flag + " = '" + *flags.line + "'"};
    spec.origins["line"] = flag;
  }
  if (!flags.source.empty()) {
    const std::string flag = spec.origins["sources.x"] = "flag --source-x";
    for (const double x : flags.source) check_flag(flag, x, kPlaceAlong, faults);
    if (flags.source.size() > 2 || flags.source.front() > flags.source.back())
      faults.push_back(flag + " = " + list_text(flags.source) + ": must be one place, as 20, or from and to, as 20,40");
    profile.source = {flags.source.front(), flags.source.back()};
  }
  if (flags.release_height) {
    const std::string flag = spec.origins["sources.release_height"] = "flag --release-height";
    check_flag(flag, *flags.release_height, bounds_of("sources.release_height"), faults);
    spec.release_height = {*flags.release_height, *flags.release_height};
  }
  if (!flags.screens.empty()) {
    const std::string flag = spec.origins["screens.x"] = "flag --screen-x";
    for (const double x : flags.screens) check_flag(flag, x, kPlaceAlong, faults);
    if (const auto twice = repeated(flags.screens))
      faults.push_back(flag + " = " + list_text(flags.screens) + ": has " + text_of(*twice) +
                       " twice, must name each place once");
    profile.screens = flags.screens;
  }
}

/// Adds a fault for what is not given and must be, or is given in two ways.
void check_given(const ScenarioSpec& spec, std::vector<std::string>& faults) {
  const auto given = [&](const std::string& key) { return spec.origins.contains(key); };
  const std::string in = spec.scenario.where.empty() ? "" : spec.scenario.where + ": ";
  const auto named = [&](const std::string& key) {
    return spec.origin(key).starts_with("flag") ? spec.origin(key) : in + key;
  };
  const bool csv = given("profile"), dem = given("dem"), line = given("line");
  if (csv && (dem || line))
    faults.push_back(named(dem ? "dem" : "line") + ": is given beside " + named("profile") +
                     " = \"FILE.csv\", must be one of the two: leave out one");
  if (!csv && dem != line)
    faults.push_back(named(dem ? "dem" : "line") + ": is given without " + (dem ? "line (--line)" : "dem (--dem)") +
                     ", must come with it");
  if (!csv && !dem && !line)
    faults.push_back(in +
                     "no terrain: give --dem and --line, or in the file dem = \"FILE\" and line = \"FILE\", or "
                     "profile = \"FILE.csv\" (columns x, z)");
  if (csv && given("surface"))
    faults.push_back(named("surface") + ": is of a DEM, must be left out for a profile = \"FILE.csv\"");
  if (!given("sources.x"))
    faults.push_back(in +
                     "no sources: give --source-x 60 or --source-x 50,70, or in the file [sources] x = 60 or "
                     "x = [50, 70], in m along the profile");
}

void read_profile_keys(ScenarioSpec& spec, const std::string& file, std::vector<std::string>& faults) {
  spec.scenario = {std::filesystem::absolute(file).lexically_normal().string(), file};
  allow_folder_of(file);
  const TomlValue root = read_toml(file, file);
  refuse_other_kind(root, file, FileKind::Profile);
  ProfileReader(spec, file, faults).read(TableReader(&root, "", file, faults));
}

}  // namespace

ScenarioSpec read_profile_spec(const ProfileFlags& flags, std::vector<std::string>& faults) {
  const std::string& file = flags.run.scenario;
  ScenarioSpec spec;
  spec.profile.emplace();
  start_with_preset(spec, flags.run, kDefaultProfilePreset, faults);
  if (!file.empty()) read_profile_keys(spec, file, faults);
  flatten(spec.default_ground, file + ": ground.zones.default", faults);
  for (ZoneSpec& zone : spec.zones) flatten(zone, file + ": ground.zones." + zone.name, faults);
  lay_flags(spec, flags.run, faults);
  lay_profile_flags(spec, flags, faults);
  check_effects(spec, faults);
  check_effect_zones(spec, faults);
  sort_by_line(faults, file);
  check_given(spec, faults);  // these faults have no line and come last
  return spec;
}

}  // namespace talus::io
