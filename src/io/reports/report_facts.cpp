#include "report_facts.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>

#include "io/files/own_files.hpp"
#include "io/results/acting_record.hpp"
#include "io/results/recorded_run.hpp"
#include "io/results/recorded_screens.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/files/staged_files.hpp"
#include "talus/io/gdal/crs.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kMostTexts = 200, kMostText = 1000, kMostSettings = 2000;  // a page stays readable
constexpr std::int64_t kMostCells = 1'000'000;                                   // of a side

std::string text_of_value(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string command_of(const Json& json) {
  std::string text;
  for (const std::string& word : texts_of(json, "command")) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

RecordedGrid grid_of(const Json& json) {
  RecordedGrid grid;
  grid.columns = static_cast<int>(whole_number(json.at("columns"), 2, kMostCells));
  grid.rows = static_cast<int>(whole_number(json.at("rows"), 2, kMostCells));
  grid.cell_x = number_of(json, "cell_x_m");
  grid.cell_y = number_of(json, "cell_y_m");
  grid.west = number_of(json, "west");
  grid.north = number_of(json, "north");
  if (!(grid.cell_x > 0.0 && grid.cell_y > 0.0)) throw InputError("its cells have no size");
  grid.crs = shortened(crs_name(json.at("crs_wkt").get<std::string>()), 120);
  return grid;
}

/// Barriers with a height: one of 0 m is off.
std::vector<StandingBarrier> barriers_of(const Json& json) {
  std::vector<StandingBarrier> barriers;
  for (const Json& one : json.value("barriers", Json::array()))
    if (const double height = number_of(one, "height_m"); height > 0.0)
      barriers.push_back({recorded_line(one), height, shortened(text_of_value(one.at("capacity_kj")), 40),
                          number_of(one, "caught"), number_of(one, "over"), number_of(one, "broken")});
  return barriers;
}

std::vector<RecordedSetting> settings_of_record(const Json& json) {
  std::vector<RecordedSetting> settings;
  for (const Json& one : json.at("settings")) {
    if (settings.size() == kMostSettings) break;
    settings.push_back({one.at("key").get<std::string>(), shortened(text_of_value(one.at("value")), kMostText),
                        one.value("unit", ""), one.value("source", "")});
  }
  return settings;
}

std::optional<GullyFacts> gullies_of(const Json& json) {
  if (!json.contains("steep_gullies")) return std::nullopt;
  const Json& gullies = json.at("steep_gullies");
  GullyFacts facts{.blocks = number_of(gullies, "blocks")};
  if (!gullies.contains("worst_cell")) return facts;
  const Json& worst = gullies.at("worst_cell");
  facts.x = number_of(worst, "x");
  facts.y = number_of(worst, "y");
  facts.worst_blocks = number_of(worst, "blocks");
  facts.passages = number_of(worst, "passages");
  return facts;
}

void read_counts(const Json& json, RunFacts& run) {
  run.released = json.at("released").get<double>();
  run.source_cells = number_of(json, "source_cells");
  if (json.contains("diameters_m")) run.diameters = json.at("diameters_m").get<std::pair<double, double>>();
  run.per_source = number_of(json, "trajectories_per_source");
  run.impacts = number_of(json, "impacts");
  run.kilometres = 1e-3 * number_of(json, "trajectory_metres");
  run.touched_cells = number_of(json, "touched_cells");
  if (json.contains("rounds")) run.rounds = number_of(json.at("rounds"), "done");
  for (const auto& [end, count] : json.at("ends").items()) run.ends.emplace_back(end, count.get<double>());
  double ended = 0.0;
  for (const auto& end : run.ends) ended += end.second;
  if (ended != run.released)
    throw InputError("it has " + text_of(run.released) + " released blocks, and ends of " + text_of(ended));
  if (!json.contains("energy_line_deg")) return;
  const Json& line = json.at("energy_line_deg");
  run.energy_line = {number_of(line, "least"), number_of(line, "p5"), number_of(line, "p50")};
  run.energy_line_stops = number_of(line, "stops");
  run.energy_line_farther = number_of(line, "farther_than_m");
}

RunFacts facts_of(const Json& json) {
  RunFacts run;
  run.version = json.value("version", "");
  run.command = command_of(json);
  run.status = json.value("status", "");
  run.plan = json.value("plan", "");
  run.plan_of_hazard = plan_of_tally(json);
  run.of_profile = is_of_profile(json);
  run.deformation_coefficient = number_of(json, "deformation_coefficient");
  read_counts(json, run);
  run.left_into_gaps = number_of(json, "left_into_gaps");
  run.left_with_pieces = number_of(json, "left_with_pieces");
  run.limit_with_pieces = number_of(json, "limit_with_pieces");
  run.gullies = gullies_of(json);
  run.grid = grid_of(json.at("grid"));
  run.screens = recorded_screens(json);
  run.barriers = barriers_of(json);
  run.pieces = number_of(json, "pieces");
  run.effects = acting_in(json);
  run.settings = settings_of_record(json);
  run.fitted_ground = has_fitted_ground(json);
  run.count_rotation = counts_rotation(json);
  for (const Json& one : json.value("inputs", Json::array()))
    run.inputs.push_back(
        {one.at("role").get<std::string>(), one.at("path").get<std::string>(), one.value("sha256", "")});
  for (const Json& one : json.value("reprojections", Json::array())) {
    const Json accuracy = one.value("accuracy_m", Json());
    run.reprojections.push_back({one.at("role").get<std::string>(), one.at("operation").get<std::string>(),
                                 accuracy.is_number() ? std::optional(accuracy.get<double>()) : std::nullopt});
  }
  run.warnings = texts_of(json, "warnings");
  run.notes = texts_of(json, "notes");
  return run;
}

}  // namespace

double RunFacts::end(const std::string& name) const {
  const auto found = std::ranges::find(ends, name, &std::pair<std::string, double>::first);
  return found == ends.end() ? 0.0 : found->second;
}

const InputFile* RunFacts::input(const std::string& role) const {
  const auto found = std::ranges::find(inputs, role, &InputFile::role);
  return found == inputs.end() ? nullptr : &*found;
}

std::vector<const RecordedSetting*> RunFacts::settings_of(const std::string& beginning) const {
  std::vector<const RecordedSetting*> found;
  for (const RecordedSetting& setting : settings)
    if (setting.key.starts_with(beginning)) found.push_back(&setting);
  return found;
}

std::string too_large_for_page(const std::filesystem::path& table) {
  if (std::filesystem::file_size(table) <= kMostPageTable) return "";
  return table.filename().string() + " has more than " + std::to_string(kMostPageTable >> 20U) + " MB";
}

RunFacts read_facts(const std::filesystem::path& folder) {
  require_results(folder);
  const std::filesystem::path file = folder / "run.json";
  RunFacts run = understood(file, facts_of);
  run.files = files_of_record(file);
  run.written = day_of(file);
  return run;
}

/// Puts the classes of hazard.json into words.
static void read_classes(const Json& matrix, HazardFacts& hazard) {
  hazard.energies = matrix.at("energies_kj").get<std::vector<double>>();
  hazard.years = matrix.at("years").get<std::vector<double>>();
  const std::vector<std::string> names = hazard.class_names = texts_of(matrix, "names");
  const Json& rows = matrix.at("classes");
  if (!rows.is_array() || rows.size() != hazard.energies.size() + 1)
    throw InputError("its matrix must have one row of classes more than energies");
  for (const Json& row : rows) {
    if (!row.is_array() || row.size() != hazard.years.size() + 1)
      throw InputError("each row of its matrix must have one class more than years");
    hazard.classes.emplace_back();
    for (const Json& number : row) {
      if (!number.is_number_unsigned() || number.get<std::size_t>() >= names.size())
        throw InputError("a class of its matrix must be the number of one of its " + std::to_string(names.size()) +
                         " names, from 0");
      hazard.classes.back().push_back(names[number.get<std::size_t>()]);
    }
  }
}

std::vector<std::string> all_warnings(const RunFacts& run, const std::optional<HazardFacts>& hazard) {
  std::vector<std::string> warnings = run.warnings;
  if (!hazard) return warnings;
  for (const std::string& warning : hazard->warnings)
    if (std::ranges::count(warnings, warning) == 0) warnings.push_back(warning);
  return warnings;
}

std::optional<HazardFacts> read_hazard_facts(const std::filesystem::path& folder, const RunFacts& run) {
  const std::filesystem::path file = folder / "hazard.json";
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return std::nullopt;
  const bool incomplete =
      understood(file, [](const Json& json) { return json.value("status", "") == StagedFiles::kIncomplete; });
  if (incomplete)
    throw InputError(file.string() +
                     ": the hazard maps are incomplete, as talus hazard was killed while it replaced them; repeat it "
                     "with --overwrite");
  return understood(file, [&](const Json& json) {
    HazardFacts hazard;
    hazard.command = command_of(json);
    hazard.events_per_year = number_of(json, "events_per_year");
    hazard.left_per_year = number_of(json, "left_per_year");
    const Json object = json.value("object", Json());
    hazard.object = object.is_object() ? "an object " + text_of(number_of(object, "width_m")) + " m wide" : "a cell";
    if (json.contains("matrix")) read_classes(json.at("matrix"), hazard);
    hazard.warnings = texts_of(json, "warnings");
    hazard.files = files_of_record(file);
    hazard.frequency = frequency_of(json);
    const Json of_run = json.value("run", Json::object());
    hazard.same_run = of_run.value("plan", "") == run.plan_of_hazard;
    return hazard;
  });
}

std::string day_text(std::time_t time) {
  std::tm parts{};
  std::array<char, 16> text{};
  if (gmtime_r(&time, &parts) == nullptr) return "";
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts)};
}

std::string day_of(const std::filesystem::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) != 0 ? "" : day_text(status.st_mtime);
}

std::vector<std::string> texts_of(const Json& json, const char* key) {
  std::vector<std::string> texts;
  const Json list = json.value(key, Json::array());
  for (const Json& one : list) {
    if (texts.size() == kMostTexts) {
      texts.push_back("... and " + std::to_string(list.size() - kMostTexts) + " more");
      break;
    }
    if (one.is_string()) texts.push_back(shortened(one.get<std::string>(), kMostText));
  }
  return texts;
}

double number_of(const Json& json, const char* key, double otherwise) {
  if (!json.contains(key) || json.at(key).is_null()) return otherwise;
  const double number = json.at(key).get<double>();
  if (!std::isfinite(number)) throw InputError(std::string("its number '") + key + "' is not finite");
  return number;
}

}  // namespace talus::io
