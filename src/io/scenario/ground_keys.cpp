#include "ground_keys.hpp"

#include <algorithm>
#include <charconv>

#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

constexpr Bounds kCode{"code", "1", "what stands for the zone in a raster", 0.0, 1e15, Bounds::Closed, true};
constexpr const char* kDefaultZone = "default";  // the ground outside all zones

/// The key x of a zone on a profile: [from, to], or a list of such intervals.
std::vector<Range> intervals_of(TableReader& table) {
  if (table.value() == nullptr) return {};  // [ground.zones] x = ... beside no [ground.zones.NAME]: said already
  const TomlValue* value = table.find("x");
  if (value == nullptr) {
    table.faults().push_back(table.file() + ":" + std::to_string(table.value()->line) + ": " + table.full("x") +
                             " is missing, must say where the zone is: x = [from, to] in m, or a list of these");
    return {};
  }
  const bool many =
      value->kind == TomlValue::Kind::List && !value->items.empty() && value->items[0].kind == TomlValue::Kind::List;
  std::vector<Range> intervals;
  for (const TomlValue& item : many ? value->items : std::vector<TomlValue>{*value}) {
    const std::vector<TomlValue>& ends = item.items;
    if (item.kind != TomlValue::Kind::List || ends.size() != 2 || ends[0].kind != TomlValue::Kind::Number ||
        ends[1].kind != TomlValue::Kind::Number || !(ends[0].number < ends[1].number))
      table.fault("x", item, "must be [from, to] in m, from below to, or a list of such intervals");
    else
      intervals.push_back({ends[0].number, ends[1].number});
  }
  return intervals;
}

}  // namespace

std::optional<std::string> fault_of_code(const std::string& text) {
  double code = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, code);
  if (error != std::errc() || rest != end) code = kNotGiven;
  if (const auto fault = fault_of(kCode, code)) return fault;
  code += 0.0;  // not -0
  if (text_of(code) != text) return "must be written as the number that the raster holds, " + text_of(code);
  return std::nullopt;
}

void lay_preset_over_include(ScenarioSpec& spec) {
  if (spec.origin("ground.default") != kPresetFlag) return;
  std::vector<std::string> lost;
  for (const auto& [key, origin] : spec.default_ground.own) lost.push_back(key);
  if (!lost.empty())
    spec.warnings.push_back("flag --preset = '" + spec.default_ground.preset +
                            "' takes the place of the default ground of " + spec.include.path + ", with its " +
                            joined(lost) + ": leave the flag out to keep them");
  spec.default_ground.ground = find_preset(spec.default_ground.preset).ground;
  spec.default_ground.own.clear();
}

void check_zones_have_file(const ScenarioSpec& spec, std::vector<std::string>& faults) {
  if (spec.zones.empty() || !spec.ground.path.empty()) return;
  if (!spec.zones_where.empty()) {
    faults.push_back(spec.zones_where + ": [ground.zones] without file in [ground], must say where the zones are");
    return;
  }
  std::vector<std::string> names;
  for (const ZoneSpec& zone : spec.zones) names.push_back(zone.name);
  faults.push_back(
      spec.include.where + ": describes zones of ground (" + shortened(joined(names), 200) + "): must come with " +
      (spec.scenario.path.empty() ? "--zones" : "file in [ground] of the scenario") + ", which says where they are");
}

void GroundReader::read(TableReader& ground) {
  flag_ = spec_.origin("ground.default") == kPresetFlag;
  if (const auto name = ground.text("default")) {
    ZoneSpec asked = spec_.default_ground;
    if (set_preset(ground, "default", *name, asked) && !flag_) {
      spec_.default_ground = asked;
      spec_.origins["ground.default"] = origin_;
    }
  }
  TableReader zones = ground.table("zones");
  if (zones.value() == nullptr) return;
  refuse_two_defaults(ground, zones);
  if (zones.value()->find(kDefaultZone) != nullptr) read_zone(zones.table(kDefaultZone), spec_.default_ground);
  for (const auto& [name, value] : zones.value()->members) {
    if (name == kDefaultZone) continue;
    const auto known = std::find_if(spec_.zones.begin(), spec_.zones.end(),
                                    [&zone = name](const ZoneSpec& z) { return z.name == zone; });
    ZoneSpec start = known == spec_.zones.end() ? spec_.default_ground : *known;
    if (known == spec_.zones.end()) start.code.clear(), start.intervals.clear();  // they belong to the default ground
    start.name = name;
    const bool is_new = known == spec_.zones.end();
    read_zone(zones.table(name), std::move(start));
    if (is_new) warn_of_name(ground.file(), spec_.zones.back(), value);
  }
  if (spec_.zones.size() > 255)
    faults_.push_back(ground.file() + ": [ground.zones] has " + std::to_string(spec_.zones.size()) +
                      " zones, must be at most 255");
}

void GroundReader::refuse_two_defaults(TableReader& ground, const TableReader& zones) {
  const TomlValue *one = ground.value()->find("default"), *zone = zones.value()->find(kDefaultZone);
  const TomlValue* other = zone == nullptr || zone->kind != TomlValue::Kind::Table ? nullptr : zone->find("preset");
  if (one == nullptr || other == nullptr || one->text == other->text) return;
  ground.fault("default", *one,
               "[ground.zones.default] preset is '" + other->text +
                   "': both are the ground outside all zones, must be one: leave out the other");
}

void GroundReader::warn_of_name(const std::string& file, const ZoneSpec& zone, const TomlValue& table) {
  const bool is_of_itself = table.find("preset") != nullptr || zone.gives_all();
  if (is_of_itself || std::ranges::count(presets(), zone.name, &Preset::name) == 0) return;
  spec_.warnings.push_back(
      file + ": [ground.zones." + zone.name + "] has no preset: what it does not give is that of the default ground (" +
      zone.preset + "), not that of the preset of its name; give it preset = \"" + zone.name + "\", or another name");
}

bool GroundReader::set_preset(TableReader& table, const std::string& key, const std::string& name, ZoneSpec& zone) {
  try {
    zone.ground = find_preset(name).ground;
    zone.preset = name;
    zone.own.clear();
    return true;
  } catch (const InputError& error) {
    table.fault(key, *table.value()->find(key), error.what());
    return false;
  }
}

void GroundReader::read_zone(TableReader table, ZoneSpec zone) {
  const bool is_default = zone.name == kDefaultZone;
  if (const auto preset = table.text("preset")) {
    const ZoneSpec before = zone;
    if (set_preset(table, "preset", *preset, zone) && !(is_default && flag_))
      spec_.origins[is_default ? "ground.default" : table.full("preset")] = origin_;
    if (is_default && flag_) zone = before;  // the preset of the flag wins; single parameters stay
  }
  if (on_profile_) {
    if (!is_default) zone.intervals = intervals_of(table);
  } else if (const auto code = table.number("code", kCode)) {
    zone.code = text_of(*code);
  }
  for (const auto& field : ground_fields()) {
    const std::string key(field.key);
    if (key == "shape_min" || key == "shape_max") continue;
    if (const auto value = table.number(key, field)) {
      field.set(zone.ground, *value);
      zone.own[key] = origin_;
    }
  }
  if (const auto shape = table.range("shape", ground_fields().back())) {
    zone.ground.shape_min = shape->low;
    zone.ground.shape_max = shape->high;
    zone.own["shape"] = origin_;
  }
  table.finish();
  store(std::move(zone));
}

void GroundReader::store(ZoneSpec zone) {
  if (zone.name == kDefaultZone) {
    spec_.default_ground = std::move(zone);
    return;
  }
  const auto known =
      std::find_if(spec_.zones.begin(), spec_.zones.end(), [&](const ZoneSpec& z) { return z.name == zone.name; });
  if (known == spec_.zones.end())
    spec_.zones.push_back(std::move(zone));
  else
    *known = std::move(zone);
}

}  // namespace talus::io
