#include "talus/io/results/run_folder.hpp"

#include <algorithm>

#include "acting_record.hpp"
#include "io/files/json.hpp"
#include "io/gdal/regular_file.hpp"
#include "recorded_profile.hpp"
#include "recorded_screens.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"

namespace talus::io {
namespace {

constexpr const char* kRunAgain = "must be as talus run has written it; run the scenario again";

double setting_of(const Json& json, const std::string& key) {
  for (const Json& setting : json.at("settings"))
    if (setting.at("key") == key) return setting.at("value").get<double>();
  throw InputError("no setting '" + key + "'");
}

/// The warnings of a run.json that `wanted` accepts.
template <class Wanted>
std::vector<std::string> warnings_of(const Json& run, Wanted wanted) {
  std::vector<std::string> found;
  if (!run.is_object()) return found;
  for (const Json& warning : run.value("warnings", Json::array()))
    if (warning.is_string() && wanted(warning.get<std::string>())) found.push_back(warning.get<std::string>());
  return found;
}

bool is_of_sizes(const std::string& warning) {
  return warning.starts_with(kSizeWarning) || warning.starts_with(kGuessWarning);
}

/// The record; nothing if there is none that can be read.
Json read_record_or_nothing(const std::filesystem::path& file) {
  try {
    return read_record(file);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

std::optional<std::string> coefficient_note(const std::filesystem::path& folder) {
  const Json json = read_record_or_nothing(folder / "run.json");
  if (!json.is_object() || !json.contains("deformation_coefficient") || !json["deformation_coefficient"].is_number())
    return std::nullopt;
  return coefficient_note(json["deformation_coefficient"].get<double>(), is_of_profile(json));
}

std::optional<std::string> coefficient_note(double c, bool of_profile) {
  constexpr double kLowC = 0.15;  // the SEL of the paper's Table 4 asks for 0.09 to 0.16
  if (!(c > kLowC)) return std::nullopt;
  return "energies and jumps may be too low (unsafe): c = " + text_of(c) +
         " (model.deformation_coefficient) is not given by the paper, and a lower c raises both. Unless the ground was "
         "fitted to observed speeds, run with " +
         (of_profile ? "deformation_coefficient = 0.15 in [model]" : "--deformation-coefficient 0.15") +
         " as well and take the higher values: docs/barrier.md, \"The value of c\"";
}

std::optional<std::string> unusable_note(const std::filesystem::path& folder) {
  const Json json = read_record_or_nothing(folder / "run.json");
  const std::string status = json.is_object() ? json.value("status", kComplete) : kComplete;
  if (status == kComplete) return std::nullopt;
  return "the run ended with status \"" + status + "\": do not use its results";
}

std::string barriers_text(std::size_t barriers, const std::string& caught, bool pieces) {
  return std::to_string(barriers) + (barriers == 1 ? " barrier" : " barriers") + " stood in the run and caught " +
         caught + (pieces ? " blocks and pieces" : " blocks");
}

std::optional<std::string> barriers_note(const std::filesystem::path& folder) {
  const Json json = read_record_or_nothing(folder / "run.json");
  if (!json.is_object()) return std::nullopt;
  return understood(folder / "run.json", kRunAgain, [&]() -> std::optional<std::string> {
    std::size_t barriers = 0;
    double caught = 0.0;
    for (const Json& barrier : json.value("barriers", Json::array())) {
      if (!(barrier.at("height_m").get<double>() > 0.0)) continue;  // it is off
      ++barriers;
      caught += barrier.at("caught").get<double>();
    }
    if (barriers == 0) return std::nullopt;
    return barriers_text(barriers, with_decimals(caught, 0), json.value("pieces", 0.0) > 0.0) +
           ": the figures here hold only while " + (barriers == 1 ? "it stands" : "they stand");
  });
}

std::optional<std::string> wet_day_note(const std::filesystem::path& folder, bool per_year) {
  const Json json = read_record_or_nothing(folder / "run.json");
  if (!json.is_object()) return std::nullopt;
  return understood(folder / "run.json", kRunAgain, [&]() -> std::optional<std::string> {
    if (std::ranges::count(acting_in(json), "wet-ground") == 0) return std::nullopt;
    return "wet-ground acts on the day of this run, " + text_of(setting_of(json, "day")) +
           ": the figures here are those of a wet day" +
           (per_year
                ? ", and every event per year counts as on such a day; give the frequency of wet days only, and add "
                  "the hazard of the dry ones"
                : "");
  });
}

std::optional<std::string> pieces_note(const std::filesystem::path& folder) {
  const Json json = read_record_or_nothing(folder / "run.json");
  if (!json.is_object()) return std::nullopt;
  return understood(folder / "run.json", kRunAgain, [&] {
    return json.value("pieces", 0.0) > 0.0 ? std::optional<std::string>(kHitsOfPieces) : std::nullopt;
  });
}

std::string forest_text(const std::vector<std::string>& effects) {
  std::vector<std::string> stands;
  for (const char* name : {"vegetation-drag", "forest-stems"})
    if (std::ranges::count(effects, name) > 0) stands.emplace_back(name);
  return stands.empty() ? "" : "forest or other vegetation stood in the run (" + joined(stands) + ")";
}

std::optional<std::string> forest_note(const std::filesystem::path& folder) {
  const Json json = read_record_or_nothing(folder / "run.json");
  if (!json.is_object()) return std::nullopt;
  return understood(folder / "run.json", kRunAgain, [&]() -> std::optional<std::string> {
    const std::string text = forest_text(acting_in(json));
    return text.empty() ? std::optional<std::string>() : text + ": the figures here hold only while it stands";
  });
}

RunSummary read_run(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  std::error_code none;
  if (!std::filesystem::exists(file, none))
    throw InputError(folder.string() +
                     ": has no run.json that can be read, must be a folder that talus run has written");
  const std::string text = read_file(file.string(), file.string(), "a record of talus run", kMostRecord);
  return understood(file, kRunAgain, [&] {
    const Json json = parsed_record(text);
    RunSummary run;
    run.of_profile = is_of_profile(json);
    run.released = json.at("released").get<double>();
    run.density = setting_of(json, "blocks.density");
    run.cell = json.at("grid").at("cell_x_m").get<double>();
    run.crs_wkt = json.at("grid").value("crs_wkt", "");
    run.screens = recorded_screens(json);
    for (const Json& screen : json.value("screens", Json::array()))
      run.without_height.push_back(screen.value("share_without_height", 0.0));
    run.size_warnings = warnings_of(json, is_of_sizes);
    return run;
  });
}

std::vector<std::string> size_warnings_of(const std::filesystem::path& folder) {
  return warnings_of(read_record_or_nothing(folder / "run.json"), is_of_sizes);
}

std::vector<std::string> cut_source_warnings_of(const std::filesystem::path& folder, bool reweighted) {
  std::vector<std::string> found = warnings_of(read_record_or_nothing(folder / "run.json"), is_of_cut_sources);
  if (reweighted)
    for (std::string& warning : found)
      if (warning.find(kAllOnTheRest) != std::string::npos || warning.find(kEventsLost) != std::string::npos)
        warning.insert(0, "by the run's own frequencies: ");
  return found;
}

}  // namespace talus::io
