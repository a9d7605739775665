#include "effect_keys.hpp"

#include <algorithm>
#include <filesystem>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/forest.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {

namespace {

using Kind = TomlValue::Kind;

constexpr Bounds kDay{"days", "1", "number of a day", 0.0, 1e6, Bounds::Closed, true};

/// "softening or drag".
std::string strengths_of(const EffectEntry& entry) {
  std::string keys;
  for (const EffectField& field : entry.fields())
    if (field.is_strength()) keys += (keys.empty() ? "" : " or ") + std::string(entry.key_of(field));
  return keys;
}

/// Reads the table of one effect.
class EffectReader {
 public:
  EffectReader(ScenarioSpec& spec, TableReader table, const EffectEntry& entry, const std::filesystem::path& base,
               const std::string& origin)
      : spec_(spec), table_(std::move(table)), entry_(entry), name_(entry.name), base_(base), origin_(origin) {}

  void read() {
    if (table_.value() == nullptr) return;
    EffectSpec& effect = spec_.effects[name_];
    effect.where = table_.at(*table_.value()) + ": [effects." + name_ + "]";
    const bool preset = has_presets(name_) && take_preset();
    const bool listed = entry_.mapped && trees(effect);
    const bool acts = numbers(effect) || listed || preset;
    if (std::vector<int>* list = entry_.days(spec_.values.effects)) days(effect, *list);
    if (entry_.area(spec_.values.effects) != nullptr) place(effect);
    const std::size_t faults = table_.faults().size();
    table_.finish();
    if (!acts && table_.faults().size() == faults)  // else the unknown key may be a misspelt strength
      table_.faults().push_back(effect.where + " does nothing, must give " + strengths_of(entry_) +
                                (has_presets(name_) ? ", or preset" : "") + ", or be left out");
  }

 private:
  void given(const std::string& key) { spec_.origins["effects." + name_ + "." + key] = origin_; }

  /// Sets the numbers to those of the preset; numbers beside it come after. Returns whether one is named.
  bool take_preset() {
    const auto name = table_.text("preset");
    if (!name) return false;
    try {
      const EffectPreset& preset = find_preset(name_, *name);
      for (const EffectField& field : entry_.fields()) {
        field.set(spec_.values.effects, field.get(preset.numbers));
        spec_.origins["effects." + std::string(field.key)] = "preset " + *name + ": " + std::string(preset.source);
      }
    } catch (const InputError& error) {
      table_.fault("preset", *table_.value()->find("preset"), error.what());
    }
    return true;
  }

  /// A fault for each of these keys beside a list of trees.
  void not_with_trees(std::initializer_list<const char*> keys, const std::string& why) {
    for (const char* key : keys)
      if (const TomlValue* value = table_.value()->find(key)) table_.fault(key, *value, why);
  }

  /// Reads a list of trees. Returns whether one is given, here or in an included file.
  bool trees(EffectSpec& effect) {
    if (const auto file = table_.named_file("trees", base_)) {
      effect.maps = {{"trees", *file}};
      effect.zones.clear(), effect.file = {};  // replaces those of an included file
      given("trees");
      not_with_trees({"density", "diameter", "zones", "file"},
                     "must not come with trees: the trees of the list are all that stands");
    } else if (effect.maps.contains("trees") && table_.value()->find("density") != nullptr) {
      effect.maps.erase("trees");  // a stand replaces the trees of an included file
    } else if (effect.maps.contains("trees")) {
      not_with_trees({"diameter", "zones", "file"},
                     "must not come with the trees of an included file: the trees of that list are all that stands; "
                     "give density, too, for a stand instead");
    }
    return effect.maps.contains("trees");
  }

  /// Reads the name of a raster in place of a number. Returns whether there is one.
  bool raster(EffectSpec& effect, const std::string& key) {
    const TomlValue* value = table_.value()->find(key);
    if (value == nullptr) return false;
    effect.maps.erase(key);
    if (value->kind != Kind::Text) return false;
    if (const auto file = table_.named_file(key, base_)) effect.maps[key] = *file;
    given(key);
    return true;
  }

  void number(const std::string& key, const EffectField& field) {
    if (const auto value = table_.number(key, field)) {
      field.set(spec_.values.effects, *value);
      given(key);
    } else if (const TomlValue* wrong = table_.value()->find(key);
               field.by_cell && wrong != nullptr && wrong->kind == Kind::Number) {
      table_.faults().back() += centimetres_hint(field, wrong->number);
    }
  }

  /// Returns whether the effect acts: one of its strengths is given, here or in an included file.
  bool numbers(EffectSpec& effect) {
    bool strength = false;
    const bool listed = table_.value()->find("trees") != nullptr;
    for (const EffectField& field : entry_.fields()) {
      const std::string key(entry_.key_of(field));
      const bool given_before = spec_.origins.contains("effects." + name_ + "." + key);
      strength = strength || ((given_before || table_.value()->find(key) != nullptr) && field.is_strength());
      if (field.by_cell && listed) {  // a fault of its own: not_with_trees
        table_.find(key);
        continue;
      }
      if (field.by_cell && raster(effect, key)) continue;
      number(key, field);
    }
    return strength;
  }

  void days(const EffectSpec& effect, std::vector<int>& list) {
    const auto days = table_.numbers("days", kDay);
    const bool none = days ? days->empty() : table_.value()->find("days") == nullptr && list.empty();
    if (none) table_.faults().push_back(effect.where + " has no days, must list those on which it acts: days = [1, 2]");
    if (!days) return;
    list.clear();  // replaces those of an included file
    for (const double day : *days) list.push_back(static_cast<int>(day));
    given("days");
  }

  void place(EffectSpec& effect) {
    if (const TomlValue* zones = table_.find("zones")) {
      const bool names = zones->kind == Kind::List && !zones->items.empty() &&
                         std::all_of(zones->items.begin(), zones->items.end(),
                                     [](const TomlValue& item) { return item.kind == Kind::Text; });
      if (!names) table_.fault("zones", *zones, "must be a list of names of [ground.zones], like [\"meadow\"]");
      effect.zones.clear();  // replaces those of an included file
      effect.file = {};
      for (const TomlValue& item : zones->items) effect.zones.push_back(item.text);
      effect.zones_where = table_.where("zones", *zones);
      given("zones");
    }
    if (const auto file = table_.named_file("file", base_)) {
      effect.file = *file;
      given("file");
      if (table_.value()->find("zones") == nullptr)
        effect.zones.clear();
      else
        table_.fault("file", *table_.value()->find("file"), "must not come with zones: give one of the two");
    }
  }

  ScenarioSpec& spec_;
  TableReader table_;
  const EffectEntry& entry_;
  std::string name_;
  const std::filesystem::path& base_;
  const std::string& origin_;
};

}  // namespace

void read_effects(ScenarioSpec& spec, TableReader table, const std::filesystem::path& base, const std::string& origin) {
  for (const EffectEntry& entry : effect_entries())
    EffectReader(spec, table.table(std::string(entry.name)), entry, base, origin).read();
  if (const TomlValue* both = table.find("allow_both")) {
    if (both->kind != Kind::Boolean) table.fault("allow_both", *both, "must be true or false");
    spec.values.drag_and_stems = both->boolean;
    spec.origins["effects.allow_both"] = origin;
  }
  table.finish();
}

void check_effect_zones(const ScenarioSpec& spec, std::vector<std::string>& faults) {
  std::vector<std::string> known{"default"};
  for (const ZoneSpec& zone : spec.zones) known.push_back(zone.name);
  for (const auto& [name, effect] : spec.effects)
    for (const std::string& zone : effect.zones)
      if (std::find(known.begin(), known.end(), zone) == known.end())
        faults.push_back(effect.zones_where + ": there is no zone '" + zone + "'" + known_names(zone, known));
}

}  // namespace talus::io
