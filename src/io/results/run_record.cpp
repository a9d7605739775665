#include "talus/io/results/run_record.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "io/files/json.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "talus/io/gdal/lines.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/tally/histogram.hpp"
#include "talus/terrain/no_height.hpp"

namespace talus::io {
namespace {

/// To three decimals: millimetres, milliseconds.
double thousandths(double value) {
  return std::round(value * 1e3) / 1e3;
}

/// A value of a setting: a number as a number, anything else as text.
Json value_of(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return text;
  return Json::parse(text, nullptr, false).is_number() ? Json::parse(text) : Json(number);
}

Json settings_of(const LoadedScenario& loaded) {
  Json list = Json::array();
  for (const Setting& s : loaded.settings)
    list.push_back({{"key", s.key}, {"value", value_of(s.value)}, {"unit", s.unit}, {"source", s.source}});
  return list;
}

Json reprojections_of(const LoadedScenario& loaded) {
  Json list = Json::array();
  for (const Reprojection& r : loaded.reprojections)
    list.push_back(
        {{"role", r.role}, {"operation", r.operation}, {"accuracy_m", r.accuracy_m ? Json(*r.accuracy_m) : Json()}});
  return list;
}

Json grid_of(const LoadedScenario& loaded) {
  const Grid& grid = loaded.scenario.surface.grid();
  const GeoReference& geo = loaded.geo;
  return {{"columns", grid.columns}, {"rows", grid.rows},  {"cell_x_m", geo.cell_x}, {"cell_y_m", geo.cell_y},
          {"west", geo.west},        {"north", geo.north}, {"crs_wkt", geo.crs_wkt}};
}

/// Lines in map coordinates, to the millimetre: products of the folder need places along them, pages draw them.
Json lines_of(const std::vector<std::vector<Eigen::Vector2d>>& lines, const LoadedScenario& loaded) {
  const MapPlace place(loaded.geo, loaded.scenario.surface.grid());
  Json list = Json::array();
  for (const auto& line : lines) {
    Json places = Json::array();
    for (const Eigen::Vector2d& p : line) places.push_back({thousandths(place.x(p.x())), thousandths(place.y(p.y()))});
    list.push_back(std::move(places));
  }
  return list;
}

/// The screens. And, from 1 % of its length, how much of a screen has no height, where no block can cross it.
Json screens_of(const LoadedScenario& loaded) {
  Json list = Json::array();
  for (const Screen& screen : loaded.scenario.screens) {
    list.push_back({{"id", screen.id}, {"lines", lines_of(screen.lines, loaded)}});
    if (const double share = share_without_height(screen, loaded.scenario.surface.heights());
        share >= kNoticedWithoutHeight)
      list.back()["share_without_height"] = share;
  }
  return list;
}

Json barriers_of(const LoadedScenario& loaded, const Totals& totals) {
  const Barriers& barriers = loaded.scenario.barriers;
  Json list = Json::array();
  for (std::size_t i = 0; i < totals.barriers.size(); ++i) {
    const Barrier& barrier = barriers.list()[i];
    const BarrierCounts sum = totals.barriers.sum(i);
    const double capacity = 1e-3 * barrier.capacity;
    list.push_back({{"id", barrier.id},
                    {"lines", lines_of(barrier.lines, loaded)},
                    {"height_m", barrier.height},
                    {"capacity_kj", std::isfinite(capacity) ? Json(capacity) : Json("inf")},
                    {"length_m", thousandths(barriers.length(i))},
                    {"hits", sum.hits()},
                    {"caught", sum.caught},
                    {"over", sum.over},
                    {"broken", sum.broken}});
  }
  return list;
}

/// The effects that act; one that is given and does nothing is in the settings only.
Json effects_of(const LoadedScenario& loaded) {
  Json list = Json::array();
  for (const EffectUse& use : loaded.effects)
    if (use.acts()) list.push_back({{"name", use.entry->name}, {"cells", use.cells}});
  return list;
}

Json ends_of(const Totals& totals) {
  return {{"stopped", totals.ended(End::Stopped)},
          {"trapped", totals.ended(End::Trapped)},
          {"left", totals.ended(End::Left)},
          {"caught", totals.ended(End::Caught)},
          {"limit", totals.ended(End::Limit)}};
}

Json json_of(const EnergyLines& lines) {
  return {{"stops", lines.count()},
          {"farther_than_m", lines.farther_than()},
          {"least", lines.least()},
          {"p5", lines.percentile(0.05)},
          {"p50", lines.percentile(0.50)}};
}

Json json_of(const GullyRecord& gullies) {
  Json json{{"blocks", gullies.blocks}};
  if (const auto& worst = gullies.worst)
    json["worst_cell"] = {{"x", thousandths(worst->x)},
                          {"y", thousandths(worst->y)},
                          {"blocks", worst->blocks},
                          {"passages", worst->passages}};
  return json;
}

Json rounds_of(const RoundsRecord& rounds) {
  Json json{{"done", rounds.done},
            {"above_probability", rounds.asked.above},
            {"cells", rounds.reached.cells},
            {"relative_half_width", rounds.reached.half_width}};
  if (!rounds.asked.until_error) return json;
  json["asked"] = *rounds.asked.until_error;
  json["most_rounds"] = rounds.asked.most;
  json["reached"] = rounds.reached_it();
  return json;
}

/// The rounds that a finished run was asked for.
Rounds asked_in(const Json& run) {
  Rounds asked;
  if (!run.contains("rounds")) return asked;
  const Json& rounds = run.at("rounds");
  asked.count = rounds.at("done");
  asked.above = rounds.at("above_probability");
  if (!rounds.contains("asked")) return asked;
  asked.until_error = rounds.at("asked").get<double>();
  asked.most = rounds.at("most_rounds");
  return asked;
}

Json seconds(const StageSeconds& s) {
  return {{"read", thousandths(s.read)}, {"simulate", thousandths(s.simulate)}, {"write", thousandths(s.write)}};
}

}  // namespace

bool too_many_limits(const Totals& totals) {
  const auto limits = static_cast<double>(totals.limited_blocks);
  return limits > kAllowedLimitShare * static_cast<double>(totals.released);
}

std::optional<std::string> status_of_result(const std::filesystem::path& folder, const std::string& plan,
                                            const Rounds& asked) {
  try {
    const Json json = read_record(folder / "run.json");
    if (json.at("plan") != plan || asked_in(json) != asked) return std::nullopt;
    return json.at("status").get<std::string>();
  } catch (const std::exception&) {
    return std::nullopt;  // no such file, or not one of a run
  }
}

bool says_maps_end_early(const std::string& warning) {
  return std::ranges::any_of(std::array{kTrappedWarning, kGullyWarning, kLimitWarning},
                             [&](std::string_view words) { return warning.find(words) != std::string::npos; });
}

std::string energy_lines_of(std::uint64_t stops, double farther_than) {
  return "of " + grouped(static_cast<double>(stops)) + " blocks that stopped" +
         (farther_than > 0.0 ? " farther away than " + text_of(farther_than) + " m" : "");
}

std::string run_json(const RunRecord& record, const LoadedScenario& loaded) {
  const Scenario& scenario = loaded.scenario;
  const Totals& totals = record.totals;
  Json json;
  json["program"] = "talus";
  json["version"] = version();
  json["command"] = record.command;
  if (!record.folder.empty()) json["folder"] = record.folder;
  if (!record.plan.empty()) json["plan"] = record.plan;
  json["status"] = too_many_limits(totals) ? "too many trajectories ended at a limit" : kComplete;
  json["seed"] = scenario.seed;
  json["deformation_coefficient"] = scenario.impact.deformation_coefficient;
  const Range diameters = diameters_of(scenario);
  json["diameters_m"] = {json_of(diameters.low), json_of(diameters.high)};
  json["source_cells"] = scenario.sources.size();
  json["trajectories_per_source"] = scenario.trajectories;
  json["released"] = totals.released;
  if (record.rounds.done > 0) {
    json["rounds"] = rounds_of(record.rounds);
    json["rounds"]["plan"] = plan_checksum(loaded);  // of all rounds together, as hazard_tally.gz has it
  }
  if (record.parts > 1) json["parts"] = record.parts;
  const bool may_break = scenario.effects.fragmentation.threshold > 0.0;
  if (may_break) json["pieces"] = totals.pieces;
  json["ends"] = ends_of(totals);
  if (may_break) json["left_with_pieces"] = totals.left_blocks;
  if (may_break) json["limit_with_pieces"] = totals.limited_blocks;
  if (totals.limited_blocks > 0)
    json["first_limit"] = {{"source", totals.first_limit[0]}, {"block", totals.first_limit[1]}};
  if (record.left_into_gaps) json["left_into_gaps"] = *record.left_into_gaps;
  if (record.gullies) json["steep_gullies"] = json_of(*record.gullies);
  json["trajectory_metres"] = static_cast<double>(totals.length_mm) * 1e-3;
  json["trajectory_metres_plan"] = static_cast<double>(totals.plan_length_mm) * 1e-3;
  if (record.energy_lines.count() > 0) json["energy_line_deg"] = json_of(record.energy_lines);
  json["impacts"] = totals.impacts;
  json["psi_dropped"] = totals.psi_dropped;
  json["cells_scored"] = totals.cells_scored;
  json["touched_cells"] = record.touched_cells;
  json["percentile_relative_error"] = LogHistogram::kBinWidth;
  json["grid"] = grid_of(loaded);
  if (!scenario.screens.empty()) json["screens"] = screens_of(loaded);
  if (!scenario.barriers.empty()) json["barriers"] = barriers_of(loaded, totals);
  json["effects"] = effects_of(loaded);
  json["settings"] = settings_of(loaded);
  json["inputs"] = json_of(loaded.inputs);
  if (network_is_allowed()) json["network"] = "allowed";
  json["reprojections"] = reprojections_of(loaded);
  if (!loaded.notes.empty()) json["notes"] = loaded.notes;
  json["warnings"] = record.warnings;
  json["files"] = record.files;
  json["threads"] = record.threads;
  if (record.ranks > 1) json["ranks"] = record.ranks;
  if (record.lanes > 0) json["lanes"] = record.lanes;
  json["cpu_seconds"] = seconds(record.cpu);
  json["wall_seconds"] = seconds(record.wall);
  json["peak_memory_mb"] = std::round(peak_memory_mb() * 10.0) / 10.0;
  return json_text(json);
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024e-6;
  }
  return 0.0;
}

}  // namespace talus::io
