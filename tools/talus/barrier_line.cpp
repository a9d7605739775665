#include "barrier_line.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/left_blocks.hpp"
#include "talus/io/reports/barrier_report.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/simulate/screens/screens.hpp"

using talus::InputError;
using talus::Screen;
using talus::io::CrossingTable;
using talus::io::RunSummary;

namespace {

/// Throws InputError if a row of a run has no value of some column.
void require_all_values(const CrossingTable& crossings, const std::string& file) {
  for (const std::size_t told : {crossings.speed.size(), crossings.energy.size(), crossings.height.size(),
                                 crossings.mass.size(), crossings.places.size()})
    if (told != crossings.count)
      throw InputError(file +
                       ": has rows without speed, jump height, mass or place, must be as talus run has written it; "
                       "run the scenario again");
  for (const CrossingTable::Again& a : crossings.again)
    if (std::isnan(a.speed + a.height + a.mass + a.place.x() + a.place.y()))
      throw InputError(file +
                       ": has rows of further crossings without speed, jump height, mass or place, must be as talus "
                       "run has written it; run the scenario again");
}

/// Throws InputError if nothing crosses the screen, with what this may come from.
void require_crossings(const CrossingTable& crossings, const RunSummary& run, const std::string& folder,
                       const Screen& screen) {
  if (crossings.count > 0) return;
  const auto gap = talus::io::gap_note(without_height(run, screen));
  const auto left = talus::io::left_note(run, left_without_crossing(run, folder, crossings), 0);
  throw InputError((std::filesystem::path(folder) / "screens.csv").string() + ": no block crosses screen '" +
                   screen.id + "': " +
                   (gap || left ? "this does not say that a barrier is not needed there: " + (gap ? *gap : *left)
                                : "a barrier is not needed there, or the line lies uphill of the sources, or barriers "
                                  "of the run catch the blocks before it, or the run has too few trajectories to say"));
}

}  // namespace

std::vector<std::string> screen_ids(const RunSummary& run) {
  std::vector<std::string> ids;
  for (const Screen& screen : run.screens) ids.push_back(screen.id);
  return ids;
}

const Screen& screen_of(const RunSummary& run, const std::string& folder, const std::string& id) {
  if (run.screens.empty() || !std::filesystem::exists(std::filesystem::path(folder) / "screens.csv"))
    throw InputError(folder +
                     ": the run kept no crossings (no screens.csv), must have had --screens, or [screens] file in its "
                     "scenario: add lines that blocks cross and run it again");
  if (id.empty() && run.screens.size() == 1) return run.screens.front();
  if (id.empty())
    throw InputError("--screen: must say at which of the screens of the run the barrier stands: " +
                     talus::joined(screen_ids(run)));
  for (const Screen& screen : run.screens)
    if (screen.id == id) return screen;
  throw InputError("--screen: the run has no screen '" + id + "'" + talus::known_names(id, screen_ids(run)));
}

double without_height(const RunSummary& run, const Screen& screen) {
  return run.without_height[static_cast<std::size_t>(&screen - run.screens.data())];
}

CrossingTable simulated_crossings(const RunSummary& run, const std::string& folder, const Screen& screen) {
  const auto in_folder = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  const std::string file = in_folder("screens.csv");
  CrossingTable crossings = talus::io::read_crossings(file, screen.id);
  const auto in_summary = talus::io::crossings_in_summary(in_folder("screens_summary.csv"), screen.id);
  if (in_summary && *in_summary != crossings.rows)
    throw InputError(file + ": has " + std::to_string(crossings.rows) + " crossings of screen '" + screen.id +
                     "', screens_summary.csv beside it says " + std::to_string(*in_summary) +
                     ": must be as talus run has written it; copy it again, or run the scenario again");
  require_crossings(crossings, run, folder, screen);
  require_all_values(crossings, file);
  return crossings;
}

std::optional<std::size_t> left_without_crossing(const RunSummary& run, const std::string& folder,
                                                 const CrossingTable& crossings) {
  if (run.pieces) return std::nullopt;                                                // a piece may have left alone
  if (!(run.left > talus::io::kWarnedLeftShare * run.released)) return std::nullopt;  // too few for a note
  const auto left = talus::io::blocks_that_left(folder);
  if (!left || static_cast<double>(left->size()) != run.left) return std::nullopt;
  std::set<std::string> crossed;
  for (std::size_t i = 0; i < crossings.count; ++i) crossed.insert(crossings.source[i] + ',' + crossings.block[i]);
  return std::ranges::count_if(*left, [&](const std::string& block) { return !crossed.contains(block); });
}

CrossingTable observed_crossings(const std::string& file, const std::string& screen) {
  CrossingTable crossings = talus::io::read_crossings(file, screen);
  if (crossings.count == 0)
    throw InputError(
        file + ": has no row of screen '" + screen + "'" +
        (crossings.others.empty() ? "" : " (there are rows of '" + crossings.others.begin()->first + "')") +
        ", must have one per observed block");
  return crossings;
}

std::vector<std::string> notes_on_observed(const CrossingTable& observed, const std::string& file,
                                           const RunSummary& run) {
  std::vector<std::string> notes;
  const std::vector<std::string> ids = screen_ids(run);
  for (const auto& [id, rows] : observed.others)
    if (std::ranges::find(ids, id) == ids.end())
      notes.push_back(file + ": " + std::to_string(rows) + " rows are of screen '" + id +
                      "', which the run does not have: they count nowhere. Is it " + talus::joined(ids) + "?");
  if (observed.rows > observed.count)
    notes.push_back(file + ": " + std::to_string(observed.rows - observed.count) + " of " +
                    std::to_string(observed.rows) +
                    " rows repeat a block (its id, source and block): only its first crossing counts");
  return notes;
}

std::vector<talus::LineCrossing> first_crossings(const CrossingTable& table, const Screen& screen) {
  std::vector<talus::LineCrossing> crossings;
  for (std::size_t i = 0; i < table.count; ++i)
    crossings.push_back({.speed = table.speed[i],
                         .height = table.height[i],
                         .mass = table.mass[i],
                         .along = talus::place_along(screen, table.places[i]),
                         .block = table.number[i],
                         .piece = i});
  return crossings;
}

std::vector<talus::LineCrossing> with_later_ones(std::vector<talus::LineCrossing> first, const CrossingTable& table,
                                                 const Screen& screen) {
  for (const CrossingTable::Again& again : table.again) {
    talus::LineCrossing crossing = first[again.first];
    crossing.speed = again.speed;
    crossing.height = again.height;
    crossing.mass = again.mass;
    crossing.along = talus::place_along(screen, again.place);
    first.push_back(crossing);
  }
  std::erase_if(first, [](const auto& c) { return !(c.weight > 0.0); });
  return first;
}
