#include "report_checks.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/scenario/fitted_on.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/products/interval.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"

namespace talus::io {
namespace {

using Mark = Check::Mark;
using Checks = std::vector<Check>;

std::string percent_of(double count, double all) {
  return percent(all > 0.0 ? count / all : 0.0);
}

/// The largest cells that show benches and gullies [m].
constexpr double kFineCell = 2.0;

bool warned_of(const RunFacts& run, std::string_view words) {
  return std::ranges::any_of(run.warnings, [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

/// "2 barriers stood in the run and caught 3 335 blocks".
std::string standing_text(const RunFacts& run) {
  double caught = 0.0;
  for (const StandingBarrier& barrier : run.barriers) caught += barrier.caught;
  return barriers_text(run.barriers.size(), grouped(caught), run.pieces > 0.0);
}

/// All effects: those that acted in the run, those that it gives and that did nothing in it, and the others.
struct EffectNames {
  std::vector<std::string> acting, idle, off;
};

EffectNames effects_of(const RunFacts& run) {
  EffectNames names;
  for (const EffectEntry& entry : effect_entries()) {
    const std::string name(entry.name);
    const bool given = !run.settings_of("effects." + name + ".").empty();
    const bool acts = std::ranges::count(run.effects, name) > 0;
    (acts ? names.acting : given ? names.idle : names.off).push_back(name);
  }
  return names;
}

/// The presets of the ground, each once.
/// @param zones  also those that zones start from
std::vector<std::string> presets_of(const RunFacts& run, bool zones) {
  std::vector<std::string> presets;
  for (const RecordedSetting* setting : run.settings_of("ground.")) {
    const bool of_zone = zones && setting->key.ends_with(".preset");
    if (!of_zone && !setting->is_of_preset()) continue;
    std::string name = of_zone ? setting->value : setting->source.substr(7);
    if (std::ranges::count(presets, name) == 0) presets.push_back(std::move(name));
  }
  return presets;
}

/// Blocks that stay on the staircases of steep gullies.
void check_gullies(const RunFacts& run, Checks& checks) {
  if (!run.gullies || !(run.released > 0.0)) return;
  const GullyFacts& gullies = *run.gullies;
  std::string found = grouped(gullies.blocks) + " of " + grouped(run.released) + " blocks (" +
                      percent_of(gullies.blocks, run.released) + ")";
  if (gullies.worst_blocks > 0.0)
    found += "; most at x = " + with_decimals(gullies.x, 1) + ", y = " + with_decimals(gullies.y, 1) + ": " +
             grouped(gullies.worst_blocks) + " of the " + grouped(gullies.passages) + " that cross this cell";
  checks.push_back({gullies.blocks > kWarnedGullyShare * run.released ? Mark::Act
                    : gullies.blocks > 0.0                            ? Mark::Look
                                                                      : Mark::Fine,
                    "Blocks that stay in steep gullies", found,
                    "The cells of the DEM are a staircase there, whose treads hold blocks that would go on: below, the "
                    "maps may end too early. Above 3 %: take a survey with smaller cells."});
}

/// Advice on blocks that leave the terrain: a larger DEM, gaps to be filled, or both.
std::string advice_on_left_blocks(const RunFacts& run) {
  if (run.of_profile) return "The results do not show how far they would go. Above 1 %: take a longer profile.";
  const std::string text = "The maps do not show how far they would go. Above 1 %: ";
  const std::string fill =
      "fill holes of the survey inside the DEM (gdal_fillnodata.py -md N, half the width of the widest in cells); a "
      "lake may stay.";
  if (!(run.left_into_gaps > 0.0)) return text + "take a larger DEM.";
  return text +
         (run.left_into_gaps < std::max(run.end("left"), run.left_with_pieces) ? "take a larger DEM, and " : "") + fill;
}

void check_ends(const RunFacts& run, Checks& checks) {
  const auto share = [&](double count) { return run.released > 0.0 ? count / run.released : 0.0; };
  const auto found = [&](double count) {
    return grouped(count) + " of " + grouped(run.released) + " blocks (" + percent_of(count, run.released) + ")";
  };
  const double left = std::max(run.end("left"), run.left_with_pieces), by_pieces = left - run.end("left");
  checks.push_back(
      {share(left) > kWarnedLeftShare ? Mark::Act
       : left > 0.0                   ? Mark::Look
                                      : Mark::Fine,
       run.of_profile ? "Blocks that leave the profile" : "Blocks that leave the DEM",
       found(left) + (by_pieces > 0.0 ? ", " + grouped(by_pieces) + " of them with smaller pieces only" : "") +
           (run.left_into_gaps > 0.0 ? ", " + grouped(run.left_into_gaps) + " of them into gaps inside the DEM" : ""),
       advice_on_left_blocks(run)});
  checks.push_back(
      {share(run.end("trapped")) > kWarnedTrappedShare ? Mark::Act
       : run.end("trapped") > 0.0                      ? Mark::Look
                                                       : Mark::Fine,
       "Blocks that are trapped", found(run.end("trapped")),
       std::string("Held in pits or between walls on ground too steep to rest on. Above 3 %: look at the ") +
           (run.of_profile ? "profile" : "DEM") + " there."});
  const double limited = std::max(run.end("limit"), run.limit_with_pieces);
  checks.push_back({limited > 0.0 ? Mark::Look : Mark::Fine, "Blocks cut short by a limit", found(limited),
                    "Their path, or that of a piece, was not followed to its end."});
  if (run.status != "complete")
    checks.push_back({Mark::Act, "The run", run.status, "The run did not complete properly: do not use its results."});
  if (auto note = later_version_note(run.version))
    checks.push_back({Mark::Act, "The version", run.version, *note + "."});
}

void check_sizes(const RunFacts& run, Checks& checks) {
  const std::string unit = run.of_profile ? "step" : "cell";  // of a profile the record has a grid of its steps
  const std::string title = run.of_profile ? "Steps and blocks" : "Cells and blocks";
  const std::string sizes = unit + "s of " + with_digits(run.grid.cell_x, 4) + " m";
  if (!run.diameters) {
    checks.push_back({Mark::Look, title, sizes + "; diameters: see the settings",
                      "A " + unit + " much larger than a block hides the ground that the block meets."});
  } else {
    const auto& [small, large] = *run.diameters;
    const bool wide = run.grid.cell_x > 5.0 * small || (!run.of_profile && run.grid.cell_x > kFineCell);
    checks.push_back(
        {wide ? Mark::Look : Mark::Fine, title,
         sizes + ", blocks of " + metres({small, large}) + ": a " + unit + " is " +
             with_digits(run.grid.cell_x / large, 2) +
             (small < large ? " to " + with_digits(run.grid.cell_x / small, 2) : std::string()) + " diameters wide",
         run.of_profile ? "The ground between the steps is smooth; its roughness is in the ground's parameters. A "
                          "profile over a DEM shows no more than the cells of the DEM, however short the step."
                        : "The ground between the centres of the cells is a smooth patch; its roughness is in the "
                          "ground's parameters. Cells above 2 m smooth benches and gullies away, and lower jumps "
                          "(unsafe): compare with a finer DEM where there is one."});
  }
  const bool warned = warned_of(run, kOtherSizes);
  checks.push_back({warned ? Mark::Act : Mark::Fine, "Sizes of the blocks and the fit of the ground",
                    warned ? "a warning of the run says that they differ" : "no warning",
                    "A ground holds for blocks of the sizes to which it was fitted."});
}

void check_numbers(const CheckedRun& checked, Checks& checks) {
  const RunFacts& run = checked.run;
  const auto released = static_cast<std::uint64_t>(std::clamp(run.released, 0.0, 1e15));
  std::string found = grouped(run.per_source) + " per source cell, " + grouped(run.source_cells) + " source cells";
  bool few = run.per_source < 50.0;
  const auto bounds = [&](double p, const std::string& where) {
    const auto hits = static_cast<std::uint64_t>(std::llround(p * run.released));
    if (released == 0 || hits == 0 || hits > released) return;
    const Interval i = probability_bounds(hits, released, kConfidence);
    found += "; " + where + ": " + percent(p) + " [" + with_digits(100.0 * i.low, 3) + ", " +
             with_digits(100.0 * i.high, 3) + "]";
    few = few || i.high - i.low > 0.4 * p;
  };
  for (const ReportMap& map : checked.sheet.maps)
    if (map.name == "impact_probability" && map.largest <= 1.0) bounds(map.largest, "most often hit cell");
  bounds(1e-3, "a cell that one block in 1000 crosses");
  checks.push_back({few ? Mark::Look : Mark::Fine, "Number of blocks", found,
                    std::string("95 % bounds of the number of blocks alone. Where they are wide: --trajectories") +
                        (run.of_profile ? "." : ", or --until-error.")});
}

/// The fitted ground: is it better than the measurements alone, and are its numbers known?
void check_fit(const FitPart& fit, Checks& checks) {
  const std::string unknown = fit.not_identifiable();
  std::string found = "fitted: " + fit.file + "; " + skill_of_fit_text(fit.skill);
  if (!unknown.empty()) found += "; " + unknown;
  std::string why = "A fit holds for its slope, its blocks and its kind of DEM.";
  if (fit.skill.share <= 0.0)
    why = "The measurements without any model tell as well or better where blocks go: do not use this fit.";
  else if (!(fit.skill.interval.low > 0.0))
    why += " It may be no better than the measurements without any model.";
  else if (!unknown.empty())
    why += " A number that is not identifiable is one of many that fit as well: vary it.";
  const bool good = fit.skill.share > 0.0 && fit.skill.interval.low > 0.0 && unknown.empty() && fit.note.empty();
  checks.push_back({fit.skill.share <= 0.0 ? Mark::Act : good ? Mark::Fine : Mark::Look, "Ground", found, why});
}

void check_ground(const CheckedRun& checked, Checks& checks) {
  const RunFacts& run = checked.run;
  const std::vector<std::string> presets = presets_of(run, !checked.fit);
  if (checked.fit) check_fit(*checked.fit, checks);
  if (!presets.empty())
    checks.push_back(
        {Mark::Look, "Ground from presets", joined(presets),
         "A first guess from other slopes. Compare with silent witnesses: where do old blocks lie? Vary it."});
  if (checked.fit || warned_of(run, kOtherTerrain)) {
    const bool other = warned_of(run, kOtherTerrain);
    checks.push_back({other ? Mark::Act : Mark::Fine, "DEM of the fit and DEM of the run",
                      other ? "a warning of the run says that they differ" : "like cells and surface",
                      "A fitted ground makes up for what its DEM does not show."});
  }
  if (warned_of(run, kOtherCoefficient))
    checks.push_back({Mark::Act, "c of the fit and c of the run", "a warning of the run says that they differ",
                      "A fitted ground holds for the c of its fit alone: fit it again with this c."});
  if (const auto low_c = coefficient_note(run.deformation_coefficient, run.fitted_ground)) {
    const std::size_t end = low_c->find(". ");  // what is; then what to do
    checks.push_back({Mark::Look, "Deformation coefficient c", low_c->substr(0, end),
                      end == std::string::npos ? "" : low_c->substr(end + 2)});
  }
}

/// "profile p.csv", or "line.gpkg over the DEM dem.tif".
std::string profile_text(const RunFacts& run) {
  const auto name = [&](const char* role) {
    const InputFile* const file = run.input(role);
    return file == nullptr ? std::string() : shortened(std::filesystem::path(file->path).filename().string(), 300);
  };
  return run.input("dem") == nullptr ? "profile " + name("profile") : name("line") + " over the DEM " + name("dem");
}

/// Terrain and sources of a run on a profile.
void check_profile(const RunFacts& run, Checks& checks) {
  checks.push_back(
      {Mark::Look, "Profile", profile_text(run),
       "Trees, bridges, roofs and interpolated holes of a DEM become terrain. Look at profile.svg: does it "
       "go down the fall line?"});
  const auto places = run.settings_of("sources.x");
  checks.push_back({Mark::Look, "Sources", places.empty() ? "" : "x = " + places.front()->value + " m",
                    "Is this where blocks break off? Their place and height decide how fast they are."});
}

/// Terrain and sources of a run on a DEM.
void check_terrain(const CheckedRun& checked, Checks& checks) {
  const bool relief = !checked.sheet.relief.empty();
  checks.push_back({relief ? Mark::Look : Mark::Act, "DEM", relief ? "drawn under the maps" : checked.sheet.relief_note,
                    "Trees, bridges, roofs and interpolated holes become terrain. Look at the relief."});
  checks.push_back({Mark::Look, "Sources", grouped(checked.run.source_cells) + " source cells, drawn on every map",
                    "Are they what you drew? A source that is missing makes every map too low."});
}

void check_inputs(const CheckedRun& checked, Checks& checks) {
  const RunFacts& run = checked.run;
  if (run.of_profile)
    check_profile(run, checks);
  else
    check_terrain(checked, checks);
  for (const Reprojection& one : run.reprojections) {
    const bool good = one.accuracy_m && *one.accuracy_m <= 0.5 * run.grid.cell_x;
    checks.push_back({good ? Mark::Fine : Mark::Look, "Coordinates of " + one.role,
                      "brought to the system of the DEM, accuracy " +
                          (one.accuracy_m ? with_digits(*one.accuracy_m, 3) + " m" : std::string("unknown")),
                      "By: " + one.operation});
  }
  const std::size_t warnings = all_warnings(run, checked.hazard).size();
  checks.push_back({warnings == 0 ? Mark::Fine : Mark::Act, "Warnings of the run",
                    warnings == 0 ? "none" : std::to_string(warnings) + ", listed above",
                    "For each, note why it does not matter here, or fix the cause."});
}

/// "; a source releases nothing ..." if warnings of the run say so; else empty.
std::string cut_sources_text(const RunFacts& run) {
  if (!std::ranges::any_of(run.warnings, is_of_cut_sources)) return "";
  std::string text;
  if (warned_of(run, kEventsLost)) text += "; a source releases nothing (see the warnings), and its events are lost";
  if (warned_of(run, kAllOnTheRest))
    text += "; a part of a source releases nothing (see the warnings), and all of its events fall on the rest";
  return text.empty() ? "; a source, or a part of one, releases nothing (see the warnings)" : text;
}

void check_hazard(const CheckedRun& checked, Checks& checks) {
  if (!checked.has_frequencies) {
    checks.push_back({Mark::Look, "Frequency", "none is declared",
                      "Nothing on this page is per year: probabilities are of one block that falls somewhere."});
    return;
  }
  const std::string cut = cut_sources_text(checked.run);
  const Mark mark = cut.empty() ? Mark::Look : Mark::Act;
  if (!checked.hazard) {
    checks.push_back(
        {mark, "Frequency", "declared, but talus hazard was not run" + cut, "Run it for return periods and classes."});
    return;
  }
  const HazardFacts& hazard = *checked.hazard;
  checks.push_back(
      {mark, "Frequency",
       with_digits(hazard.events_per_year, 4) + " events per year, by " + frequency_text(hazard.frequency) + cut,
       "Every return period and class is as good as they are."});
  const bool left = hazard.left_per_year > 0.01 * hazard.events_per_year;
  checks.push_back(
      {left ? Mark::Act : Mark::Fine, "Events that leave the DEM",
       with_digits(hazard.left_per_year, 3) + " of " + with_digits(hazard.events_per_year, 3) + " per year",
       "Beyond the DEM the hazard goes on, and no map shows it."});
  checks.push_back({Mark::Look, "Whose hazard", "of " + hazard.object,
                    "A larger cell is hit more often; compare maps for one width only."});
  if (const auto share = checked.sheet.undecided)
    checks.push_back(
        {*share > 0.05 ? Mark::Look : Mark::Fine, "Cells whose class is not decided",
         percent(*share, 2) + " of the pixels with a class",
         "There the classes at the 95 % bounds of the number of blocks differ (map \"Class not decided\"). "
         "More blocks decide them: --trajectories, or --until-error."});
  if (!hazard.same_run)
    checks.push_back({Mark::Act, "Hazard of another run", "hazard.json names another plan than run.json",
                      "Run talus hazard again with --overwrite."});
}

void check_barriers(const RunFacts& run, Checks& checks) {
  if (run.barriers.empty()) return;
  double over = 0.0;
  std::vector<std::string> broken;
  for (const StandingBarrier& barrier : run.barriers) {
    over += barrier.over;
    if (barrier.broken > 0.0) broken.push_back(barrier.line.id + " (" + grouped(barrier.broken) + ")");
  }
  checks.push_back(
      {broken.empty() ? Mark::Look : Mark::Act, "Barriers of the run",
       standing_text(run) + "; " + grouped(over) + " went over; " +
           (broken.empty() ? "none was broken through" : "broken through: " + joined(broken)),
       "The maps hold only while they stand as entered: where, how high, how strong. One that breaks is too "
       "weak for this slope."});
}

void check_effects(const RunFacts& run, Checks& checks) {
  const auto [acting, idle, off] = effects_of(run);
  if (const std::string forest = forest_text(acting); !forest.empty())
    checks.push_back({Mark::Look, "Forest", forest,
                      "The maps hold only while it stands, as dense and as thick as entered. Storm, fire, insects and "
                      "felling take it away: compare with a run without it."});
  checks.push_back(
      {Mark::Look, "Effects",
       "acting: " + (acting.empty() ? "none" : joined(acting)) +
           (idle.empty() ? "" : "; given, but does nothing here: " + joined(idle)) + "; off: " + joined(off),
       "Is there forest, deep or wet ground, a block that breaks? An effect that is off is not in the maps."});
}

void check_screens(const CheckedRun& checked, Checks& checks) {
  constexpr double kFew = 100.0;
  std::vector<std::string> few;
  for (const ScreensPart::Row& row : checked.screens.rows)
    if (row.quantity == "speed" && row.blocks < kFew) few.push_back(row.screen + " (" + grouped(row.blocks) + ")");
  if (checked.screens.rows.empty()) return;
  checks.push_back({few.empty() ? Mark::Fine : Mark::Look, "Blocks at the screens",
                    few.empty() ? "at least 100 at each" : "fewer than 100 at " + joined(few),
                    "P95 of few blocks is uncertain, P99 more so."});
}

}  // namespace

std::vector<Check> checks_of(const CheckedRun& checked) {
  Checks checks;
  check_inputs(checked, checks);
  check_ends(checked.run, checks);
  check_gullies(checked.run, checks);
  check_sizes(checked.run, checks);
  check_ground(checked, checks);
  check_numbers(checked, checks);
  check_hazard(checked, checks);
  check_screens(checked, checks);
  check_barriers(checked.run, checks);
  check_effects(checked.run, checks);
  return checks;
}

Markup checks_html(const std::vector<Check>& checks) {
  Markup html =
      "<h2>Before you sign</h2>\n<p>What this run says of each point. Tick it when you have looked; "
      "the model cannot do that for you.</p>\n<table><tr><th></th><th>point</th><th>this run</th><th>why</th></tr>\n"_html;
  for (const Check& check : checks) {
    const Markup start = check.mark == Mark::Act    ? "<tr class='act'><td class='k'>\u2610 act</td><td>"_html
                         : check.mark == Mark::Look ? "<tr class='look'><td class='k'>\u2610 look</td><td>"_html
                                                    : "<tr><td class='k'>\u2610 fine</td><td>"_html;
    html += start + check.what + "</td><td class='b'>" + check.found + "</td><td>" + check.why + "</td></tr>\n";
  }
  return html +
         "</table>\n<table class='sign'><tr><td>Reviewed by</td><td></td><td>Date</td><td></td><td>Signature</td><td>"
         "</td></tr></table>\n";
}

Markup assumptions_html(const CheckedRun& checked) {
  const auto [acting, idle, off] = effects_of(checked.run);
  Markup html =
      "<h2>Assumptions</h2>\n<ul>\n<li>Impact model of PIERRE 2 (Mitchell and Hungr): "
      "stochastic rebounds of a sphere on rough ground. "_html;
  html += acting.empty() ? std::string("No further effect acts.") : "Further effects: " + joined(acting) + ".";
  if (!idle.empty()) html += " Given, but does nothing here: " + joined(idle) + ".";
  html += "</li>\n<li>";
  if (!checked.run.barriers.empty()) {
    html += standing_text(checked.run) + "; the maps hold only while they stand.";
    html += "</li>\n<li>";
  }
  if (const std::string forest = forest_text(acting); !forest.empty()) {
    html += forest + "; the maps hold only while it stands.";
    html += "</li>\n<li>";
  }
  html +=
      checked.hazard
          ? "Frequencies, return periods and classes follow from " + frequency_text(checked.hazard->frequency) + ": " +
                with_digits(checked.hazard->events_per_year, 4) +
                " events per year together. Impact probabilities, energies, speeds, jump heights and the figures of "
                "screens are not weighted by them: there each simulated block counts as much as any other, a rare "
                "large one as much as a frequent small one."
          : "Probabilities are given that one block falls, each source cell as likely as any other. They "
            "are not per year.";
  html +=
      "</li>\n<li>Crossing a cell is meant in plan, at any height: a block that flies over a road has crossed "
      "it.</li>\n"
      "<li>Energy is translational";
  if (checked.run.count_rotation)
    html += ", but thresholds, return periods, intensities, classes and objects count the energy with rotation";
  html +=
      "; P95 is of the largest energy of each path in the cell, over the paths that cross "
      "it.</li>\n<li>Jump height is vertical, from the terrain to the block's lowest point: add its diameter for its "
      "top.</li>\n<li>"
      "Bounds hold for the number of blocks of this model. They know nothing of a wrong DEM, source or "
      "parameter.</li>\n"
      "</ul>\n";
  return html;
}

}  // namespace talus::io
