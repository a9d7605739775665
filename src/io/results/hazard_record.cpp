#include "talus/io/results/hazard_record.hpp"

#include "frequency_record.hpp"
#include "io/files/json.hpp"
#include "io/scenario/table_reader.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/version.hpp"
#include "talus/products/hazard_table.hpp"

namespace talus::io {
namespace {

using Kind = TomlValue::Kind;

constexpr Bounds kClassEnergy{"energies", "kJ", "between classes of intensity", 0.0, 1e9, Bounds::AboveMin};
constexpr Bounds kYears{"years", "years", "between classes of return period", 0.0, 1e6, Bounds::AboveMin};

/// @return whether the file has classes; else those of the default stay
bool read_classes(TableReader& table, HazardMatrix& matrix) {
  const TomlValue* value = table.find("classes");
  if (value == nullptr) return false;
  std::vector<std::vector<int>> classes;
  for (const TomlValue& row : value->items) {
    classes.emplace_back();
    for (const TomlValue& item : row.items) {
      if (item.kind != Kind::Number || !(item.number >= 0.0 && item.number <= 15.0) ||
          item.number != static_cast<int>(item.number)) {
        table.fault("classes", item, "must be a whole number from 0 to 15");
        return true;
      }
      classes.back().push_back(static_cast<int>(item.number));
    }
  }
  matrix.classes = std::move(classes);
  return true;
}

void read_names(TableReader& table, HazardMatrix& matrix) {
  const TomlValue* value = table.find("names");
  if (value == nullptr) return;
  matrix.names.clear();
  for (const TomlValue& item : value->items) {
    if (item.kind != Kind::Text) table.fault("names", item, "must be text in quotation marks");
    matrix.names.push_back(item.text);
  }
}

Json json_of(const HazardMatrix& matrix) {
  return {
      {"energies_kj", matrix.energies}, {"years", matrix.years}, {"classes", matrix.classes}, {"names", matrix.names}};
}

}  // namespace

HazardMatrix read_matrix(const std::string& path) {
  HazardMatrix matrix;
  const TomlValue root = read_settings(path, path, "energies, years, classes or names");
  std::vector<std::string> faults;
  TableReader table(&root, "", path, faults);
  if (const auto energies = table.numbers("energies", kClassEnergy)) matrix.energies = *energies;
  if (const auto years = table.numbers("years", kYears)) matrix.years = *years;
  const bool own_classes = read_classes(table, matrix);
  read_names(table, matrix);
  table.finish();
  if (faults.empty())
    if (const std::string fault = fault_of(matrix); !fault.empty())
      faults.push_back(
          path + ": " + fault +
          (fault.starts_with("classes") && !own_classes ? "; the file has none, and the default has 3 rows of 4" : ""));
  if (!faults.empty()) throw InputFaults(faults, faults.size());
  return matrix;
}

std::string hazard_json(const HazardRecord& record) {
  const WeightScale& scale = record.header.rules.scale;
  Json json;
  json["program"] = "talus";
  json["version"] = version();
  json["command"] = record.command;
  json["run"] = {{"version", record.header.version}, {"plan", record.header.plan}};
  json["events_per_year"] = scale.total;
  json["left_per_year"] = left_per_year(record.header);
  json["trajectories"] = scale.trajectories;
  json["equal_weights"] = scale.equal;
  json["largest_weight_per_year"] = scale.largest_weight();
  json["confidence"] = kConfidence;
  json["energy_relative_error"] = EnergyBins::kRelativeWidth;
  json["energy_thresholds_kj"] = record.header.rules.bins.thresholds();
  json["count_rotation"] = record.header.rules.with_rotation;
  json["matrix"] = json_of(record.matrix);
  json["matrix_file"] = record.matrix_file.empty() ? Json("default") : Json(record.matrix_file);
  if (record.width > 0.0)
    json["object"] = {{"width_m", record.width}, {"passages_below_m", record.header.passages_below}};
  else
    json["object"] = "cell";
  if (record.curves)
    json["curve_energies_kj"] = energies_of_curves(record.header.rules, {record.width, record.header.passages_below});
  json["cells"] = record.cells;
  if (!record.objects_file.empty()) json["objects"] = {{"file", record.objects_file}, {"replayed", true}};
  if (!record.frequency.file.empty()) {
    json["frequency"] = json_of(record.frequency, scale.total);
    json["frequency"]["replayed"] = true;
  }
  json["warnings"] = record.warnings;
  json["files"] = record.files;
  return json_text(json);
}

std::string frequency_file_of(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "hazard.json";
  if (!std::filesystem::exists(file)) return {};
  const Json record = read_record(file);
  const Json name = record.value("frequency", Json::object()).value("file", Json());
  return name.is_string() ? name.get<std::string>() : "";
}

}  // namespace talus::io
