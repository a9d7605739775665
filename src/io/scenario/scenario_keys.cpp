#include "scenario_keys.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "barrier_keys.hpp"
#include "effect_keys.hpp"
#include "file_kind.hpp"
#include "fitted_on.hpp"
#include "frequency_keys.hpp"
#include "ground_keys.hpp"
#include "io/gdal/csv_table.hpp"
#include "io/gdal/input_name.hpp"
#include "io/gdal/vrt_check.hpp"
#include "scenario_flags.hpp"
#include "surface_key.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {

namespace {

using Kind = TomlValue::Kind;

class SpecReader {
 public:
  /// @param path  of the file; `file` is its name in messages
  SpecReader(ScenarioSpec& spec, const std::string& path, const std::string& file, std::string origin,
             std::vector<std::string>& faults)
      : spec_(spec),
        file_(file),
        origin_(std::move(origin)),
        base_(std::filesystem::absolute(path).parent_path()),
        faults_(faults) {}

  void read(const TomlValue& root) {
    TableReader top(&root, "", file_, faults_);
    read_include(top);
    lay_preset_over_include(spec_);
    read_vrt_folders(top);
    named_file(top, "dem", spec_.dem);
    surface(top);
    read_common(top);
    read_sources(top.table("sources"));
    read_ground(top.table("ground"));
    read_output(top.table("output"));
    TableReader screens = top.table("screens");
    named_file(screens, "file", spec_.screens);
    if (screens.value() != nullptr && screens.find("file") == nullptr)
      faults_.push_back(file_ + ":" + std::to_string(screens.value()->line) +
                        ": [screens] names no file, must have file = \"...\", the lines of the screens");
    screens.finish();
    TableReader barriers = top.table("barriers");
    const std::size_t faults_before = faults_.size();
    named_file(barriers, "file", spec_.barriers);
    read_barrier_lines(spec_, barriers, origin_);
    const bool any = barriers.find("file") != nullptr || !spec_.barrier_lines.empty();
    finish_barriers(barriers, any, faults_before, "file = \"...\" or line = [...]");
    read_frequency(spec_, top.table("frequency"), origin_);
    read_fit(spec_, top.table("fit"), base_);
    top.finish();
  }

  /// Reads the keys that a profile has, too.
  void read_common(TableReader& top) {
    for (const char* key : {"seed", "trajectories", "day"}) scalar(top, key);
    read_blocks(top.table("blocks"));
    read_model(top.table("model"));
    read_effects(spec_, top.table("effects"), base_, origin_);
  }

  /// Reads the keys of a file that holds only a model.
  void read_model_keys(const TomlValue& root) {
    TableReader top(&root, "", file_, faults_);
    FittedOn& fitted = spec_.fitted_on;
    fitted.file = spec_.include;
    given("fit");
    fitted.surface = surface(top);
    read_fitted(top, fitted);
    TableReader ground = top.table("ground");
    GroundReader(spec_, origin_, faults_).read(ground);
    ground.finish();
    TableReader model = top.table("model");
    read_impact(model);
    if (model.find("deformation_coefficient") != nullptr)
      fitted.deformation_coefficient = spec_.values.impact.deformation_coefficient;
    model.finish();
    read_effects(spec_, top.table("effects"), base_, origin_);
    TableReader barriers = top.table("barriers");
    const std::size_t faults_before = faults_.size();
    read_barrier_lines(spec_, barriers, origin_);
    finish_barriers(barriers, !spec_.barrier_lines.empty(), faults_before, "line = [...]");
    read_instrument_bias(spec_, top);
    top.finish();
  }

 private:
  void given(const std::string& key) { spec_.origins[key] = origin_; }

  /// Ends [barriers]. A fault where it names none and has no other fault, which would say more.
  void finish_barriers(TableReader& barriers, bool any, std::size_t faults_before, const std::string& allowed) {
    barriers.finish();
    if (barriers.value() != nullptr && !any && faults_.size() == faults_before)
      faults_.push_back(file_ + ":" + std::to_string(barriers.value()->line) +
                        ": [barriers] names no barrier, must have " + allowed);
  }

  /// Reads the included file first: the scenario's own keys override it.
  void read_include(TableReader& top) {
    const auto text = top.text("include");
    if (!text) return;
    named_file(top, "include", spec_.include);
    std::error_code none;
    if (!std::filesystem::exists(spec_.include.path, none)) return;  // reported later, with the other files
    talus::io::read_model_keys(spec_, spec_.include.path, *text, "include " + *text, faults_);
  }

  /// Folders below which a VRT may name files: a run writes down those that it was allowed.
  void read_vrt_folders(TableReader& top) {
    const TomlValue* const list = top.find("vrt_folders");
    if (list == nullptr) return;
    const auto is_text = [](const TomlValue& item) { return item.kind == Kind::Text; };
    if (list->kind != Kind::List || !std::ranges::all_of(list->items, is_text))
      return top.fault("vrt_folders", *list, "must be a list of folders, like [\"/data/tiles\"]");
    for (const TomlValue& item : list->items) allow_folder(absolute_path(item.text, base_));
    given("vrt_folders");
  }

  void named_file(TableReader& table, const std::string& key, NamedFile& file) {
    auto named = table.named_file(key, base_);
    if (table.value() != nullptr && table.value()->find(key) != nullptr) given(table.full(key));
    if (named) file = std::move(*named);
  }

  std::optional<SurfaceKind> surface(TableReader& top) {
    const auto kind = read_surface(top);
    if (!kind) return kind;
    spec_.surface = *kind;
    given("surface");
    return kind;
  }

  void scalar(TableReader& table, const std::string& key) {
    const std::string full = table.full(key);
    for (const auto& field : scenario_fields())
      if (field.key == full)
        if (const auto value = table.number(key, field)) {
          field.set(spec_.values, *value);
          given(full);
        }
  }

  void read_sources(TableReader table) {
    named_file(table, "file", spec_.sources);
    if (const auto range = table.range("release_height", bounds_of("sources.release_height"))) {
      spec_.release_height = *range;
      given("sources.release_height");
    }
    read_fields(table.table("fields"));
    table.finish();
  }

  void read_fields(TableReader table) {
    for (const std::string& name : source_field_names()) {
      const TomlValue* const value = table.find(name);
      if (value == nullptr) continue;
      const bool none = value->kind == Kind::Text && value->text.empty();  // that field is not read
      const auto field = none ? std::optional<std::string>("") : table.text(name);
      if (!field) continue;
      spec_.source_fields[name] = {*field, table.where(name, *table.value()->find(name))};
      given(table.full(name));
    }
    table.finish();
  }

  void read_blocks(TableReader table) {
    scalar(table, "density");
    read_diameter(table);
    if (const auto axes = table.numbers("axes", bounds_of("blocks.axes"))) {
      const std::vector<double>& a = *axes;
      if (a.size() == 3 && a[0] >= a[1] && a[1] >= a[2]) {
        spec_.values.blocks.axes = Vec3(a[0], a[1], a[2]);
        given("blocks.axes");
      } else {
        table.fault("axes", *table.value()->find("axes"), "must be three numbers, L1 >= L2 >= L3");
      }
    }
    table.finish();
  }

  void read_diameter(TableReader& table) {
    const TomlValue* value = table.find("diameter");
    if (value == nullptr) return;
    given("blocks.diameter");
    const auto is_table = [](const TomlValue& item) { return item.kind == Kind::Table; };
    if (value->kind == Kind::Table) {
      read_power_law(*value);
    } else if (value->kind == Kind::List && !value->items.empty() &&
               std::any_of(value->items.begin(), value->items.end(), is_table)) {
      for (const TomlValue& item : value->items) read_class(table, item);
      check_frequencies(table, *value);
    } else if (const auto range = table.range("diameter", bounds_of("blocks.diameter"))) {
      spec_.values.blocks.classes = {BlockClass{*range}};
    }
  }

  /// All classes have a frequency or none. On a profile none: its results are of the blocks that fall, not per year.
  void check_frequencies(TableReader& table, const TomlValue& value) {
    const auto given =
        std::ranges::count_if(value.items, [](const TomlValue& item) { return item.find("frequency") != nullptr; });
    if (given != 0 && spec_.profile)
      table.fault("diameter", value,
                  "a profile has no annual frequencies: leave frequency out, the weights give the shares");
    else if (given != 0 && given != std::ssize(value.items))
      table.fault("diameter", value,
                  "has a frequency for " + std::to_string(given) + " of " + std::to_string(value.items.size()) +
                      " classes, must have it for all or none");
  }

  void read_class(TableReader& table, const TomlValue& item) {
    if (item.kind != Kind::Table) {
      table.fault("diameter", item, "must be a table like { diameter = 1.2, weight = 1 }, as the others of the list");
      return;
    }
    TableReader entry(&item, "blocks.diameter", file_, faults_);
    BlockClass block;
    if (const auto diameter = entry.range("diameter", bounds_of("blocks.diameter"))) block.diameter = *diameter;
    if (const auto volume = entry.range("volume", bounds_of("blocks.volume")))
      block.diameter = {diameter_of(volume->low), diameter_of(volume->high)};
    if ((item.find("diameter") == nullptr) == (item.find("volume") == nullptr))
      faults_.push_back(file_ + ":" + std::to_string(item.line) + ": a class of blocks.diameter has " +
                        (item.find("volume") == nullptr ? "no diameter and no volume" : "a diameter and a volume") +
                        ", must have one of them");
    block.weight = entry.number("weight", bounds_of("blocks.weight")).value_or(1.0);
    block.frequency = entry.number("frequency", bounds_of("blocks.frequency")).value_or(kNotGiven);
    entry.finish();
    spec_.values.blocks.classes.push_back(block);
  }

  void read_power_law(const TomlValue& value) {
    TableReader law(&value, "blocks.diameter", file_, faults_);
    VolumePowerLaw& out = spec_.values.blocks.power_law;
    const auto low = law.number("volume_min", bounds_of("blocks.volume_min")),
               high = law.number("volume_max", bounds_of("blocks.volume_max"));
    const auto exponent = law.number("exponent", bounds_of("blocks.exponent"));
    for (const char* key : {"volume_min", "volume_max", "exponent"})
      if (value.find(key) == nullptr)
        faults_.push_back(file_ + ":" + std::to_string(value.line) + ": blocks.diameter: the power law has no " + key +
                          ", must be { volume_min, volume_max, exponent }");
    law.finish();
    if (!low || !high || !exponent) return;
    if (*low > *high)
      law.fault("volume_min", *value.find("volume_min"), "must not be above volume_max = " + text_of(*high));
    out = {{*low, *high}, *exponent};
  }

  void read_ground(TableReader table) {
    named_file(table, "file", spec_.ground);
    if (const auto field = table.text("field")) {
      spec_.ground_field = *field;
      given("ground.field");
      if (spec_.ground.path.empty()) table.fault("field", *table.value()->find("field"), "must come with file");
    }
    GroundReader(spec_, origin_, faults_).read(table);
    table.finish();
    const TomlValue* zones = table.value() == nullptr ? nullptr : table.value()->find("zones");
    if (zones != nullptr) spec_.zones_where = file_ + ":" + std::to_string(zones->line);
  }

  /// The parts of [model] that are the impact law.
  void read_impact(TableReader& table) {
    scalar(table, "deformation_coefficient");
    if (const auto rule = table.text("roughness")) {
      if (*rule == "clamp" || *rule == "resample") {
        spec_.values.impact.roughness = *rule == "clamp" ? Roughness::Clamp : Roughness::Resample;
        given("model.roughness");
      } else {
        table.fault("roughness", *table.value()->find("roughness"), "must be 'clamp' or 'resample'");
      }
    }
  }

  void read_model(TableReader table) {
    read_impact(table);
    for (const char* key : {"stop_speed", "trap_time", "time_limit", "impact_limit"}) scalar(table, key);
    table.finish();
  }

  void read_output(TableReader table) {
    scalar(table, "trajectories");
    thresholds(table, "energy_thresholds", spec_.values.output.energy_thresholds);
    thresholds(table, "height_thresholds", spec_.values.output.height_thresholds);
    if (const auto value = table.number("passages_below", bounds_of("output.passages_below"))) {
      spec_.values.output.passages_below = *value;
      given("output.passages_below");
    }
    truth(table, "energy_total", spec_.values.output.energy_total);
    truth(table, "count_rotation", spec_.values.output.count_rotation);
    truth(table, "bounds", spec_.values.output.bounds);
    if (const auto name = table.text("vectors")) {
      const auto format = vector_format(*name);
      if (!format) table.fault("vectors", *table.value()->find("vectors"), kVectorsRule);
      spec_.values.output.vectors = format.value_or(VectorFormat::GeoPackage);
      given("output.vectors");
    }
    table.finish();
  }

  void truth(TableReader& table, const std::string& key, bool& out) {
    const TomlValue* const value = table.find(key);
    if (value == nullptr) return;
    if (value->kind != Kind::Boolean) {
      table.fault(key, *value, "must be true or false");
      return;
    }
    out = value->boolean;
    given("output." + key);
  }

  void thresholds(TableReader& table, const std::string& key, std::vector<double>& out) {
    const auto values = table.numbers(key, bounds_of("output." + key));
    if (!values) return;
    if (values->empty() || values->size() > 32 ||
        std::adjacent_find(values->begin(), values->end(), std::greater_equal<>()) != values->end()) {
      table.fault(key, *table.value()->find(key), "must be 1 to 32 numbers that ascend, each once");
      return;
    }
    out = *values;
    given("output." + key);
  }

  ScenarioSpec& spec_;
  std::string file_, origin_;
  std::filesystem::path base_;
  std::vector<std::string>& faults_;
};

}  // namespace

void sort_by_line(std::vector<std::string>& faults, const std::string& file) {
  const auto line = [&](const std::string& fault) {
    return fault.rfind(file + ":", 0) == 0 ? std::atoi(fault.c_str() + file.size() + 1) : 0;
  };
  std::stable_sort(faults.begin(), faults.end(),
                   [&](const std::string& a, const std::string& b) { return line(a) < line(b); });
}

void read_common_keys(ScenarioSpec& spec, TableReader& top, std::vector<std::string>& faults) {
  SpecReader(spec, top.file(), top.file(), "scenario", faults).read_common(top);
}

void read_model_keys(ScenarioSpec& spec, const std::string& path, const std::string& name, const std::string& origin,
                     std::vector<std::string>& faults) {
  SpecReader(spec, path, name, origin, faults)
      .read_model_keys(read_settings(path, name, "[ground], [model], [effects] or [barriers]"));
}

/// Where an input is a VRT, the scenario that a run leaves has to allow what this one does.
static void keep_vrt_folders(ScenarioSpec& spec, std::vector<std::string>& faults) {
  const auto names_vrt = [](const auto& input) { return is_vrt(input.second->path); };
  if (!std::ranges::any_of(spec.inputs(), names_vrt)) return;
  for (const std::filesystem::path& folder : allowed_folders()) {
    if (std::ranges::count(spec.vrt_folders, folder.string()) == 0) spec.vrt_folders.push_back(folder.string());
    if (const std::string fault = fault_of_encoding(folder.string()); !fault.empty())
      faults.push_back("a folder below which a VRT may name files: " + fault);
  }
}

/// A list of numbers with spaces leaves a number for the scenario: --thresholds 30 300.
static void refuse_a_number(const std::string& scenario) {
  if (number_of_cell(scenario) && !std::filesystem::exists(scenario))
    throw InputError(scenario +
                     ": is taken for the file of a scenario, which is not there; numbers of a list are written with "
                     "commas and without spaces: --thresholds 30,300; a range of diameters is given by fields "
                     "diameter_min and diameter_max, or as [blocks] diameter = [0.5, 2] in a scenario");
}

ScenarioSpec read_spec(const RunFlags& flags, std::vector<std::string>& faults) {
  ScenarioSpec spec;
  start_with_preset(spec, flags, kDefaultPreset, faults);
  start_with_model(spec, flags, faults);
  if (!flags.scenario.empty()) {
    refuse_a_number(flags.scenario);
    spec.scenario = {std::filesystem::absolute(flags.scenario).lexically_normal().string(), flags.scenario};
    allow_folder_of(flags.scenario);
    const TomlValue root = read_toml(flags.scenario, flags.scenario);
    refuse_other_kind(root, flags.scenario, FileKind::Scenario);
    SpecReader(spec, flags.scenario, flags.scenario, "scenario", faults).read(root);
  }
  lay_flags(spec, flags, faults);
  keep_vrt_folders(spec, faults);
  check_zones_have_file(spec, faults);
  check_effect_zones(spec, faults);
  sort_by_line(faults, flags.scenario);
  const std::string in = flags.scenario.empty() ? "" : flags.scenario + ": ";
  if (spec.dem.path.empty() && !spec.origins.contains("dem"))
    faults.push_back(in + "no terrain: give dem = \"FILE\" in a scenario, or --dem FILE");
  if (spec.sources.path.empty() && !spec.origins.contains("sources.file"))
    faults.push_back(in + "no sources: give [sources] file = \"FILE\" in a scenario, or --sources FILE");
  return spec;
}

}  // namespace talus::io
