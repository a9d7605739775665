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
    check_effects();
  }

  /// Adds a fault for what is not given and must be. These faults have no line and come last.
  void check_given(const std::string& file) {
    const bool csv = is_given("profile"), dem = is_given("dem"), line = is_given("line");
    if (csv ? dem || line : !dem || !line)
      faults_.push_back(file +
                        ": no terrain, or more than one: give profile = \"FILE.csv\" (columns x, z), or "
                        "dem = \"FILE\" with line = \"FILE\"");
    if (csv && is_given("surface"))
      faults_.push_back(file + ": surface: is of a DEM, must be left out for a profile = \"FILE.csv\"");
    if (!is_given("sources.x"))
      faults_.push_back(file + ": no sources: give [sources] x = 60, or x = [50, 70], in m along the profile");
  }

 private:
  void given(const std::string& key) { spec_.origins[key] = "scenario"; }
  bool is_given(const std::string& key) const { return spec_.origins.contains(key); }

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
    std::ranges::sort(*x);
    if (const auto twice = std::ranges::adjacent_find(*x); twice != x->end())
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

  /// Adds a fault for an effect that turns a block out of the plane, and for polygons.
  void check_effects() {
    for (const auto& [name, effect] : spec_.effects) {
      if (find_effect(name)->leaves_plane)
        faults_.push_back(effect.where + ": leads blocks out of the plane of the profile, must be left out here");
      if (!effect.file.path.empty())
        faults_.push_back(effect.file.where + ": there are no polygons on a profile, must be zones");
    }
  }

  ScenarioSpec& spec_;
  ProfileSpec& profile_;
  std::vector<std::string>& faults_;
  std::filesystem::path base_;
};

/// Removes the sideways roughness of a preset. Adds a fault if the file gives one.
void flatten(ZoneSpec& zone, const std::string& table, std::vector<std::string>& faults) {
  const auto own = zone.own.find("psi_scale");
  if (own != zone.own.end() && zone.ground.psi_scale != 0.0)
    faults.push_back(table + ".psi_scale = " + text_of(zone.ground.psi_scale) +
                     ": a profile has no sideways roughness, must be 0 or left out");
  zone.ground.psi_scale = 0.0;
}

}  // namespace

ScenarioSpec read_profile_spec(const RunFlags& flags, std::vector<std::string>& faults) {
  ScenarioSpec spec;
  spec.profile.emplace();
  spec.default_ground = {
      "default", std::string(kDefaultProfilePreset), find_preset(kDefaultProfilePreset).ground, {}, {}, {}};
  spec.scenario = {std::filesystem::absolute(flags.scenario).lexically_normal().string(), flags.scenario};
  allow_folder_of(flags.scenario);
  const TomlValue root = read_toml(flags.scenario, flags.scenario);
  refuse_other_kind(root, flags.scenario, FileKind::Profile);
  ProfileReader reader(spec, flags.scenario, faults);
  reader.read(TableReader(&root, "", flags.scenario, faults));
  flatten(spec.default_ground, flags.scenario + ": ground.zones.default", faults);
  for (ZoneSpec& zone : spec.zones) flatten(zone, flags.scenario + ": ground.zones." + zone.name, faults);
  lay_flags(spec, flags, faults);
  check_effect_zones(spec, faults);
  sort_by_line(faults, flags.scenario);
  reader.check_given(flags.scenario);
  return spec;
}

}  // namespace talus::io
