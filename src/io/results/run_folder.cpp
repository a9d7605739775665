#include "talus/io/results/run_folder.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "acting_record.hpp"
#include "io/files/json.hpp"
#include "io/gdal/regular_file.hpp"
#include "io/scenario/fitted_on.hpp"
#include "recorded_run.hpp"
#include "recorded_screens.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/scenario/frequency.hpp"

namespace talus::io {
namespace {

constexpr const char* kRunAgain = "must be as talus run has written it; run the scenario again";

double setting_of(const Json& json, const std::string& key) {
  for (const Json& setting : json.at("settings"))
    if (setting.at("key") == key) return setting.at("value").get<double>();
  throw InputError("no setting '" + key + "'");
}

/// Whether a warning of a run holds for all who use its results.
bool holds_for_all(const std::string& warning) {
  return warning.starts_with(kSizeWarning) || warning.starts_with(kGuessWarning) || is_of_frequencies(warning) ||
         is_of_cut_sources(warning) || says_maps_end_early(warning) || says_fit_does_not_hold(warning);
}

/// Those warnings of the run. With another weighting those about frequencies are the ones of that, and those with
/// events per year say whose they are.
std::vector<std::string> warnings_for(const Json& run, const GivenFrequencies& frequency) {
  const bool reweighted = !frequency.file.empty();
  std::vector<std::string> found;
  for (const Json& warning : run.value("warnings", Json::array())) {
    const std::string text = warning.is_string() ? warning.get<std::string>() : "";
    if (!holds_for_all(text) || (reweighted && is_of_frequencies(text))) continue;
    const bool per_year = text.find(kAllOnTheRest) != std::string::npos || text.find(kEventsLost) != std::string::npos;
    found.push_back((reweighted && per_year ? "by the run's own frequencies: " : "") + text);
  }
  found.insert(found.end(), frequency.warnings.begin(), frequency.warnings.end());
  return found;
}

/// That the results must not be used; nothing if the run is complete.
std::optional<std::string> status_note(const Json& run) {
  const std::string status = run.value("status", kComplete);
  if (status == kComplete) return std::nullopt;
  return "the run ended with status \"" + status + "\": do not use its results";
}

/// The first two numbers of a version: results of versions that share them are read alike. 0.0 if it is none.
std::pair<int, int> series_of(std::string_view text) {
  std::pair<int, int> series{0, 0};
  const char* const end = text.data() + text.size();
  const auto [point, fault] = std::from_chars(text.data(), end, series.first);
  if (fault == std::errc() && point != end && *point == '.') std::from_chars(point + 1, end, series.second);
  return series;
}

std::optional<std::string> recorded_coefficient_note(const Json& run) {
  if (!run.contains("deformation_coefficient") || !run["deformation_coefficient"].is_number()) return std::nullopt;
  return coefficient_note(run["deformation_coefficient"].get<double>(), has_fitted_ground(run));
}

/// That the figures hold only while the barriers of the run stand; nothing if none stood there.
std::optional<std::string> standing_note(const Json& run, bool of_line) {
  std::size_t barriers = 0;
  double caught = 0.0;
  for (const Json& barrier : run.value("barriers", Json::array())) {
    if (!(barrier.at("height_m").get<double>() > 0.0)) continue;  // it is off
    ++barriers;
    caught += barrier.at("caught").get<double>();
  }
  if (barriers == 0) return std::nullopt;
  return barriers_text(barriers, with_decimals(caught, 0), run.value("pieces", 0.0) > 0.0) +
         ": the figures here hold only while " + (barriers == 1 ? "it stands" : "they stand") +
         (of_line ? "; a block that one caught uphill of this screen, or on its line, does not cross it" : "");
}

/// That the figures are those of a wet day; nothing if wet-ground does not act on the day of the run. docs/effects.md,
/// "wet-ground".
std::optional<std::string> wet_note(const Json& run, bool per_year) {
  if (std::ranges::count(acting_in(run), "wet-ground") == 0) return std::nullopt;
  return "wet-ground acts on the day of this run, " + text_of(setting_of(run, "day")) +
         ": the figures here are those of a wet day" +
         (per_year ? ", and every event per year counts as on such a day; give the frequency of wet days only, and add "
                     "the hazard of the dry ones"
                   : "");
}

/// That a barrier is designed by another energy than the classes; nothing if all are translational.
std::optional<std::string> rotation_note(const Json& run, bool of_line) {
  if (!of_line || !counts_rotation(run)) return std::nullopt;
  return "energies here are translational, as those by which nets are tested, although the thresholds and classes of "
         "this run count the rotation (count_rotation)";
}

/// That the figures hold only while the forest of the run stands; nothing if none acted there.
std::optional<std::string> stand_note(const Json& run) {
  const std::string text = forest_text(acting_in(run));
  if (text.empty()) return std::nullopt;
  return text + ": the figures here hold only while it stands";
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

std::vector<std::string> notes_of_run(const std::filesystem::path& folder, const ResultsUse& use) {
  const Json run = read_record_or_nothing(folder / "run.json");
  if (!run.is_object()) return {};
  return understood(folder / "run.json", kRunAgain, [&] {
    std::vector<std::string> notes = warnings_for(run, use.frequency);
    for (const std::optional<std::string>& note :
         {status_note(run), later_version_note(run.value("version", "")), recorded_coefficient_note(run),
          standing_note(run, use.of_line), wet_note(run, use.per_year), stand_note(run),
          rotation_note(run, use.of_line)})
      if (note) notes.push_back(*note);
    return notes;
  });
}

std::optional<std::string> later_version_note(const std::string& written) {
  if (!(series_of(version()) < series_of(written))) return std::nullopt;
  return "run.json was written by Talus " + written + ", and this is the earlier version " + std::string(version()) +
         ": what is new in it is not read; use that version or a later one";
}

std::optional<std::string> coefficient_note(double c, bool fitted) {
  constexpr double kLowC = 0.15;  // the SEL of the paper's Table 4 asks for 0.09 to 0.16
  if (!(c > kLowC)) return std::nullopt;
  return "energies, jumps, run-out and hits may be too low (unsafe): c = " + text_of(c) +
         " (model.deformation_coefficient) is not given by the paper, and a lower c raises them. " +
         (fitted
              ? "The ground was fitted, and holds for the c of its fit alone: unless speeds were measured, fit it "
                "again with [model] "
                "deformation_coefficient = 0.15 in the file of calibrate --parameters, run with that ground as well, "
                "and take the higher values"
              : "Run with --deformation-coefficient 0.15 as well, and take the higher values") +
         ": docs/barrier.md, \"The value of c\"";
}

std::optional<std::string> coefficient_note(const LoadedScenario& loaded) {
  const bool fitted =
      std::ranges::any_of(loaded.settings, [](const Setting& s) { return s.key.starts_with(kFittedNumbers); });
  return coefficient_note(loaded.scenario.impact.deformation_coefficient, fitted);
}

std::string barriers_text(std::size_t barriers, const std::string& caught, bool pieces) {
  return std::to_string(barriers) + (barriers == 1 ? " barrier" : " barriers") + " stood in the run and caught " +
         caught + (pieces ? " blocks and pieces" : " blocks");
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

RunSummary read_run(const std::filesystem::path& folder) {
  require_results(folder);
  const std::filesystem::path file = folder / "run.json";
  const std::string text = read_file(file.string(), file.string(), "a record of talus run", kMostRecord);
  return understood(file, kRunAgain, [&] {
    const Json json = parsed_record(text);
    RunSummary run;
    run.of_profile = is_of_profile(json);
    run.released = json.at("released").get<double>();
    run.left = std::max(json.value("ends", Json::object()).value("left", 0.0), json.value("left_with_pieces", 0.0));
    run.left_into_gaps = json.value("left_into_gaps", 0.0);
    run.pieces = json.value("pieces", 0.0) > 0.0;
    run.density = setting_of(json, "blocks.density");
    run.cell = json.at("grid").at("cell_x_m").get<double>();
    run.crs_wkt = json.at("grid").value("crs_wkt", "");
    run.screens = recorded_screens(json);
    for (const Json& screen : json.value("screens", Json::array()))
      run.without_height.push_back(screen.value("share_without_height", 0.0));
    return run;
  });
}

void require_plan_of_tally(const std::filesystem::path& folder, const std::string& plan) {
  const std::filesystem::path file = folder / "run.json";
  const std::string text = read_file(file.string(), file.string(), "a record of talus run", kMostRecord);
  const std::string recorded = understood(file, kRunAgain, [&] { return plan_of_tally(parsed_record(text)); });
  if (!recorded.empty() && recorded != plan)
    throw InputError((folder / kHazardFile).string() +
                     ": is of another run than run.json beside it; copy both from one folder, or run again");
}

std::optional<std::string> left_note(const RunSummary& run, const std::optional<std::size_t>& before,
                                     std::size_t crossed) {
  double lost = run.left;  // a block that crosses may have left before with a piece
  if (!run.pieces) lost = std::min(lost, run.released - static_cast<double>(crossed));
  if (before) lost = static_cast<double>(*before);
  if (!(lost > kWarnedLeftShare * run.released)) return std::nullopt;
  const bool gaps = run.left_into_gaps > 0.0;
  return (before ? "" : "up to ") + percent(lost / run.released) + " of the blocks (" + with_decimals(lost, 0) +
         " of " + with_decimals(run.released, 0) + ") left the " +
         (run.of_profile ? "profile"
          : gaps         ? "DEM or entered a gap in it"
                         : "DEM") +
         " without crossing this line first: those that would have crossed it later are missing here (unsafe); "
         "take a " +
         (run.of_profile ? "longer profile"
          : gaps         ? "larger DEM, or fill the gaps"
                         : "larger DEM");
}

}  // namespace talus::io
