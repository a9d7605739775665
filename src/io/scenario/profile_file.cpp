#include "talus/io/scenario/profile_file.hpp"

#include <algorithm>
#include <cmath>

#include "effect_places.hpp"
#include "io/files/checksum.hpp"
#include "io/gdal/csv_table.hpp"
#include "profile_keys.hpp"
#include "profile_line.hpp"
#include "scenario_flags.hpp"
#include "scenario_text.hpp"
#include "size_warning.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

constexpr double kMostColumns = 2e6;
constexpr Bounds kX{"x", "m", "along the profile", -1e7, 1e7}, kZ{"z", "m", "height", -500.0, 9000.0};

/// A key for messages: the flag that gave it, or the file and the key.
std::string named(const ScenarioSpec& spec, const std::string& key) {
  const std::string origin = spec.origin(key);
  if (origin.starts_with("flag")) return origin;
  return (spec.scenario.where.empty() ? "" : spec.scenario.where + ": ") + key;
}

/// Throws InputError if a place of the input is not on the profile.
void check_inside(const Profile& profile, double x, const std::string& key) {
  if (x >= profile.from() && x <= profile.to()) return;
  throw InputError(key + " = " + text_of(x) + ": must be on the profile, " + text_of(profile.from()) + " to " +
                   text_of(profile.to()) + " m");
}

/// Throws InputError if blocks would be released at the last column or beyond, where there is no ground.
void check_before_end(const ProfileSpec& p, const Grid& grid, const std::string& key) {
  const double last = std::round((grid.west + grid.centre_x(grid.columns - 1)) * 1e6) / 1e6, nearest = 1e-6;
  if (p.source.low > last - nearest)
    throw InputError(key + " = " + text_of(p.source.low) +
                     ": is the end of the profile, and a block released there leaves it at once: must be below " +
                     text_of(last) + " m");
  if (p.source.high > last + nearest)
    throw InputError(key + " = [" + text_of(p.source.low) + ", " + text_of(p.source.high) + "]: must end at " +
                     text_of(last) + " m at most, the last column of the profile (step = " + text_of(p.step) + " m)");
}

/// Warns of a profile that falls from its sources towards its start, as one that was drawn from the bottom up.
void warn_of_direction(const ProfileSpec& p, const Profile& profile, std::vector<std::string>& warnings) {
  double uphill = profile.height(p.source.low), downhill = profile.height(p.source.high);  // lowest, on each side
  for (const Eigen::Vector2d& node : profile.nodes) {
    if (node.x() < p.source.low) uphill = std::min(uphill, node.y());
    if (node.x() > p.source.high) downhill = std::min(downhill, node.y());
  }
  if (!(uphill < downhill)) return;
  warnings.push_back("the profile falls to " + with_decimals(uphill, 1) +
                     " m at a smaller x than the sources, and to " + with_decimals(downhill, 1) +
                     " m at a larger x: it seems drawn from the bottom up, must be drawn from the top down (x grows "
                     "downhill)");
}

void place_sources(const ScenarioSpec& spec, const Profile& profile, const Grid& grid, Scenario& parts) {
  const ProfileSpec& p = *spec.profile;
  const double west = grid.west;
  const std::string key = named(spec, "sources.x");
  check_inside(profile, p.source.low, key);
  check_inside(profile, p.source.high, key);
  check_before_end(p, grid, key);
  SourceFeature feature;
  feature.release_height = spec.release_height;
  feature.velocity = {p.vx, 0.0, p.vz};
  parts.features = {feature};
  parts.sources = {{0, 0.5 * (p.source.low + p.source.high) - west, kProfileLine, true, p.source.high - p.source.low}};
}

void place_screens(const ScenarioSpec& spec, const Profile& profile, double west, Scenario& parts) {
  for (const double x : spec.profile->screens) {
    check_inside(profile, x, named(spec, "screens.x"));
    parts.screens.push_back({text_of(x), {{{x - west, 0.5}, {x - west, 1.5}}}});
  }
}

/// Visits the columns whose centres are in [from, to), but for rounding. Returns their number.
template <class Visit>
int for_each_column(const Range& x, const Grid& grid, const Visit& visit) {
  int columns = 0;
  for (int c = 0; c < grid.columns; ++c) {
    const double centre = grid.west + grid.centre_x(c);
    if (centre < x.low - 1e-9 || centre >= x.high - 1e-9) continue;
    visit(c);
    ++columns;
  }
  return columns;
}

std::string zone_text(const ScenarioSpec& spec, const ZoneSpec& zone, const Range& x) {
  return spec.scenario.where + ": ground.zones." + zone.name + ".x = [" + text_of(x.low) + ", " + text_of(x.high) + "]";
}

/// The ground of each column: that of the last zone of the file whose interval [from, to) holds its centre.
void place_zones(const ScenarioSpec& spec, const Profile& profile, const Grid& grid, Scenario& parts) {
  parts.cover.grounds = {spec.default_ground.ground};
  parts.zone_names = {"default"};
  if (spec.zones.empty()) return;
  parts.cover.zones = Raster<std::uint8_t>(grid, 0);
  for (const ZoneSpec& zone : spec.zones) {
    parts.cover.grounds.push_back(zone.ground);
    parts.zone_names.push_back(zone.name);
    for (const Range& x : zone.intervals) {
      if (x.high <= profile.from() || x.low >= profile.to())
        throw InputError(zone_text(spec, zone, x) + ": lies off the profile, must be on " + text_of(profile.from()) +
                         " to " + text_of(profile.to()) + " m");
      for_each_column(x, grid, [&](int c) {
        parts.cover.zones.at(c, 0) = parts.cover.zones.at(c, 1) =
            static_cast<std::uint8_t>(parts.zone_names.size() - 1);
      });
    }
  }
}

/// Warns of intervals of zones that act in no column.
void warn_of_idle_zones(const ScenarioSpec& spec, const Cover& cover, std::vector<std::string>& warnings) {
  const double step = spec.profile->step;
  for (std::size_t i = 0; i < spec.zones.size(); ++i)
    for (const Range& x : spec.zones[i].intervals) {
      bool acts = false;
      const auto look = [&](int c) { acts = acts || cover.zones.at(c, 0) == i + 1; };
      const int columns = for_each_column(x, cover.zones.grid, look);
      if (columns == 0)
        warnings.push_back(zone_text(spec, spec.zones[i], x) + ": covers none of the columns, which are step = " +
                           text_of(step) + " m apart, and has no effect: make it at least as wide" +
                           (step > kProfileStep.min ? ", or give a smaller step" : ""));
      else if (!acts)
        warnings.push_back(zone_text(spec, spec.zones[i], x) +
                           ": lies wholly under later zones and has no effect: the last in the file counts; move this "
                           "one below them");
    }
}

void warn_of_presets(const ScenarioSpec& spec, std::vector<std::string>& warnings) {
  std::vector<const ZoneSpec*> zones{&spec.default_ground};
  for (const ZoneSpec& zone : spec.zones) zones.push_back(&zone);
  for (const ZoneSpec* zone : zones)
    if (find_preset(zone->preset).ground.psi_scale > 0.0)
      warnings.push_back("ground '" + zone->name + "': preset " + zone->preset +
                         " is of the 3D model; its sideways roughness is left out");
}

/// Reads the polyline: from a CSV, or from a line over a DEM.
void read_terrain_of(const ScenarioSpec& spec, LoadedProfile& out) {
  const ProfileSpec& p = *spec.profile;
  if (!p.csv.path.empty()) {
    out.profile = read_profile_csv(p.csv.path, p.step);
  } else {
    const Terrain terrain = read_terrain(spec.dem.path);
    out.loaded.warnings = terrain.warnings;
    ProfileLine line = read_profile_line(p.line.path, terrain, spec, out.loaded);
    out.profile = std::move(line.profile);
    out.map = terrain.geo;
    const Grid& grid = terrain.heights.grid;
    for (const Eigen::Vector2d& place : line.plan) out.plan.emplace_back(grid.west + place.x(), grid.south + place.y());
  }
  const double columns = (out.profile.to() - out.profile.from()) / p.step;
  if (columns > kMostColumns)
    throw InputError(named(spec, "step") + " = " + text_of(p.step) + ": would be " + text_of(std::round(columns)) +
                     " columns, must be at most " + text_of(kMostColumns) + ": give a larger step");
}

void record_inputs(const ScenarioSpec& spec, LoadedScenario& out) {
  for (const auto& [role, file] : {std::pair{"scenario", &spec.scenario},
                                   {"profile", &spec.profile->csv},
                                   {"dem", &spec.dem},
                                   {"line", &spec.profile->line}})
    if (!file->path.empty()) out.inputs.push_back(recorded_input(role, file->path));
}

}  // namespace

Eigen::Vector2d LoadedProfile::place(double x, double z) const {
  if (plan.empty()) return {x, z};
  for (std::size_t i = 1; i < plan.size(); ++i) {
    const double length = (plan[i] - plan[i - 1]).norm();
    if (!(length > 0.0)) continue;  // a doubled vertex
    if (x <= length || i + 1 == plan.size()) return plan[i - 1] + (plan[i] - plan[i - 1]) * (x / length);
    x -= length;
  }
  return plan.back();
}

Profile read_profile_csv(const std::string& path, double step) {
  const CsvTable table(path, {"x", "z"}, {"x", "z"});
  Profile profile;
  for (const CsvTable::Row& row : table.rows()) {
    const Eigen::Vector2d node(table.required(row, "x", kX), table.required(row, "z", kZ));
    if (!profile.nodes.empty() && !is_a_step(node.x() - profile.to(), step))
      table.refuse(row, "x",
                   "must be at least step = " + text_of(step) + " m beyond " + text_of(profile.to()) +
                       " of the row before: order the rows by x, or lean walls by that much" +
                       (step > kProfileStep.min ? ", or give a smaller step" : ""));
    profile.nodes.push_back(node);
  }
  if (profile.nodes.size() < 2)
    throw InputError(path + ": has " + std::to_string(profile.nodes.size()) + " nodes, must have 2 at least");
  return profile;
}

LoadedProfile load_profile(const ProfileFlags& flags) {
  std::vector<std::string> faults;
  const ScenarioSpec spec = read_profile_spec(flags, faults);
  const std::vector<const NamedFile*> files{&spec.dem, &spec.profile->csv, &spec.profile->line};
  check_encoding(files, faults);
  check_files(files, faults);
  if (!faults.empty()) throw InputFaults(faults, faults.size());
  LoadedProfile out;
  out.step = spec.profile->step;
  out.bin = spec.profile->bin;
  read_terrain_of(spec, out);
  ExtrudedProfile extruded = extrude(out.profile, out.step);
  const Grid grid = extruded.heights.grid;
  out.datum = extruded.datum;
  LoadedScenario& loaded = out.loaded;
  loaded.geo.west = grid.west;
  loaded.geo.north = grid.south + grid.height();
  loaded.geo.cell_x = grid.cell_x;
  loaded.geo.cell_y = grid.cell_y;
  loaded.geo.crs_wkt = out.map.crs_wkt;

  Scenario parts = spec.values;
  parts.impact.in_plane = true;
  place_sources(spec, out.profile, grid, parts);
  warn_of_direction(*spec.profile, out.profile, loaded.warnings);
  if (parts.blocks.classes.empty() && parts.blocks.power_law.volume.high == 0.0)
    throw InputError((spec.scenario.where.empty() ? "" : spec.scenario.where + ": ") +
                     "no block diameter, must have one: give --diameter, or [blocks] diameter in the file, in m");
  place_screens(spec, out.profile, grid.west, parts);
  place_zones(spec, out.profile, grid, parts);
  warn_of_idle_zones(spec, parts.cover, loaded.warnings);
  load_effect_places(spec, Terrain{}, parts, loaded);  // zones only: a profile has no files of polygons
  parts.surface = Surface(std::move(extruded.heights), SurfaceKind::Bilinear);
  loaded.scenario = make_scenario(std::move(parts));
  loaded.warnings.insert(loaded.warnings.end(), spec.warnings.begin(), spec.warnings.end());
  warn_of_presets(spec, loaded.warnings);
  warn_of_unused_preset(spec, loaded.warnings);
  warn_of_sizes(spec, loaded.scenario, loaded.warnings);
  tell_of_effects(loaded);
  loaded.complete_toml = toml_of(spec);
  loaded.settings = settings_of(spec);
  record_inputs(spec, loaded);
  return out;
}

}  // namespace talus::io
