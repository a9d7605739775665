#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>

#include "barrier_line.hpp"
#include "commands.hpp"
#include "crossing_weights.hpp"
#include "project.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/file_name.hpp"
#include "talus/io/files/staged_path.hpp"
#include "talus/io/gdal/crossings_file.hpp"
#include "talus/io/reports/barrier_report.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/products/hazard_matrix.hpp"
#include "talus/products/return_values.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/screens/screens.hpp"

namespace {

namespace fs = std::filesystem;
using talus::Bounds;
using talus::io::BarrierReport;
using talus::io::CrossingTable;
using talus::io::RunSummary;

struct BarrierOptions {
  std::string folder, screen, observed, frequency;
  talus::DesignFactors factors;
  double percentile = 95.0;                    // [%]
  std::optional<double> volume, density;       // [m^3], [kg/m^3]
  std::optional<double> containment, stretch;  // [%], longest [m]: kContained, kLongestStretch; not for a profile
  std::vector<double> years;                   // return periods; empty: those of the hazard matrix
  std::uint64_t seed = 1;
  bool unweighted = false, quiet = false;
};

constexpr double kContained = 99.0, kLongestStretch = 30.0;

constexpr Bounds factor(std::string_view key, std::string_view meaning) {
  return {key, "1", meaning, 1.0, 3.0};
}
constexpr Bounds kPercentile{"--percentile", "%", "percentile of speed and jump height, such as 95: not 0.95", 50.0,
                             99.99};
constexpr Bounds kContainment{"--containment", "%", "share of the crossings that the width holds, such as 99: not 0.99",
                              1.0, 100.0};
constexpr Bounds kStretch{"--stretch", "m", "longest stretch with a design of its own", 1.0, 1e6};
constexpr Bounds kVolume{"--volume", "m3", "of the design block", 0.0, 65000.0, Bounds::AboveMin};
constexpr Bounds kYears{"--return-periods", "years", "years in which the values are reached once", 0.001, 1e6};
constexpr Bounds kDensity{"--density", "kg/m3", "mass per volume of the rock", 500.0, 8000.0};

void refuse_out_of(const Bounds& bounds, double value) {
  if (const auto fault = talus::fault_of(bounds, value))
    throw talus::InputError(std::string(bounds.key) + " = " + talus::text_of(value) + ": " + *fault);
}

/// Throws InputError if a number on the command line is out of bounds.
void check_numbers(const BarrierOptions& o) {
  const std::pair<Bounds, std::optional<double>> all[] = {
      {factor("--gTr", "quality of the trajectories"), o.factors.trajectory},
      {factor("--gDp", "quality of the topography"), o.factors.topography},
      {factor("--gVol", "quality of the block's volume"), o.factors.volume},
      {factor("--gG", "quality of the rock's density"), o.factors.density},
      {factor("--gE", "safety factor of the maximum energy level"), o.factors.mel},
      {kPercentile, o.percentile},
      {kContainment, o.containment},
      {kStretch, o.stretch},
      {kVolume, o.volume},
      {kDensity, o.density}};
  for (const auto& [bounds, value] : all)
    if (value) refuse_out_of(bounds, *value);
  for (auto years = o.years.begin(); years != o.years.end(); ++years) {
    refuse_out_of(kYears, *years);
    if (std::find(o.years.begin(), years, *years) != years)
      throw talus::InputError("--return-periods: " + talus::text_of(*years) + " is given twice: give each once");
  }
}

/// Throws InputError if the crossings have no frequencies, from which alone return periods follow.
void refuse_return_periods(const BarrierOptions& o, const Weighting& weighting) {
  if (!o.years.empty() && !weighting.scale)
    throw talus::InputError("--return-periods: every block counts " + weighting.text +
                            ": give the sources a field frequency, or run with --frequency; else leave it out");
}

/// Throws InputError if what only a line on a map has was asked for.
void refuse_width_of_profile(const RunSummary& run, const BarrierOptions& o) {
  for (const auto& [key, value] : {std::pair{kContainment.key, o.containment}, {kStretch.key, o.stretch}})
    if (run.of_profile && value)
      throw talus::InputError(std::string(key) + " = " + talus::text_of(*value) + ": " + o.folder +
                              " is of a profile, where a barrier has no width and no stretches: leave it out");
}

/// A note where much of what crosses a stretch has crossed another one before: a hairpin, several lines under one id.
std::optional<std::string> again_note(const BarrierReport& report, std::size_t blocks) {
  constexpr double kFew = 0.01;  // of the crossings
  std::size_t on_stretches = 0;
  for (const talus::io::StretchRow& row : report.stretches) on_stretches += row.values.crossings;
  const std::size_t again = on_stretches - blocks;
  if (static_cast<double>(again) <= kFew * static_cast<double>(blocks)) return std::nullopt;
  return std::to_string(again) +
         " crossings on stretches are of blocks that crossed the line before, on another stretch (a winding line, or "
         "several under one id): values, width and frequencies of the whole line are those of first crossings, "
         "as if all stopped there (unsafe where they do not); give each leg a screen of its own, or take the values by "
         "stretch";
}

/// ", but in the laws and shares of the values": where crossings of sources with a frequency of 0 count all the same.
std::string where_all_count(const BarrierOptions& o, const BarrierReport& report) {
  std::string text;
  if (o.observed.empty()) text = "in the laws and shares of the values";
  if (report.width) text += std::string(text.empty() ? "" : " and ") + "in the width by the map";
  return text.empty() ? text : ", but " + text;
}

/// Leaves out what never falls. Throws InputError if the others are too few for the percentile.
void keep_falling(std::vector<talus::LineCrossing>& crossings, const BarrierOptions& o, BarrierReport& report,
                  Weighting& weighting) {
  report.never = std::erase_if(crossings, [](const auto& c) { return !(c.weight > 0.0); });
  if (report.never > 0)
    report.notes.push_back(std::to_string(report.never) +
                           " of the crossings are of sources or block classes with a frequency of 0 and count nothing" +
                           where_all_count(o, report));
  weighting.line = talus::sums_of(crossings);
  report.effective = talus::effective_number(crossings);
  const std::size_t fewest = talus::fewest_for_percentile(0.01 * o.percentile);
  if (report.effective < static_cast<double>(fewest) - 1e-9)
    throw talus::InputError((fs::path(o.folder) / "screens.csv").string() + ": only " +
                            std::to_string(crossings.size()) + " blocks cross screen '" + report.screen + "'" +
                            (weighting.scale ? ", which, weighted by frequency, count as " +
                                                   talus::with_digits(report.effective, 3) + " of equal weight"
                                             : "") +
                            ", must be " + std::to_string(fewest) + " at least for percentile " +
                            talus::text_of(o.percentile) + ": run more trajectories, or give a lower --percentile");
}

/// A quantity of crossings, in its unit.
struct CrossingQuantity {
  std::string name, unit;
  std::function<double(const talus::LineCrossing&)> of;
};

/// Adds to each design value of a quantity how often a simulated block exceeds it: its share by weight, and per year.
void add_frequencies(talus::io::Reliability& r, const CrossingQuantity& quantity,
                     std::span<const talus::LineCrossing> crossings, const Weighting& weighting) {
  for (talus::io::Reliability::Limit& limit : r.limits) {
    std::vector<talus::LineCrossing> above;
    std::ranges::copy_if(crossings, std::back_inserter(above),
                         [&](const auto& c) { return quantity.of(c) > limit.value; });
    const talus::CrossingSums counted = talus::sums_of(above);
    limit.by_frequency = counted.sum / weighting.line.sum;
    limit.per_year = weighting.per_year(counted);
  }
}

/// Why a quantity has no fit; empty if it can have one.
std::string lack_of_fit(const std::string& whose, const std::string& quantity, const std::vector<double>& values) {
  if (values.empty()) return whose + " have no values of the " + quantity;
  std::size_t positive = 0, others = 0;
  double first = 0.0;
  for (const double value : values) {
    if (!(value > 0.0)) continue;
    if (++positive == 1) first = value;
    others += value != first ? 1U : 0U;
  }
  if (positive >= talus::kFewestForWeibull && others > 0) return "";
  return whose + " hold " + std::to_string(positive) + " values of the " + quantity + " above 0" +
         (positive > 0 && others == 0 ? ", all equal" : "") + ": too few for a Weibull fit (" +
         std::to_string(talus::kFewestForWeibull) + ", not all equal)";
}

/// How often the crossings of a run exceed the design values of each quantity.
class Exceedances {
 public:
  Exceedances(BarrierReport& report, std::span<const talus::LineCrossing> crossings, const Weighting& weighting,
              std::uint64_t seed)
      : report_(report), crossings_(crossings), weighting_(weighting) {
    how_.seed = seed;
  }

  /// Adds one quantity: the fit of its values and, where the sources have frequencies, how often simulated blocks
  /// exceed its design values. A note if there are too few values for a fit.
  void add(const CrossingQuantity& quantity, const std::vector<double>& values,
           const std::vector<std::pair<std::string, double>>& limits) {
    const std::string lack = lack_of_fit(report_.values, quantity.name, values);
    talus::io::Reliability r{quantity.name, quantity.unit, {}, {}};
    if (lack.empty()) r.fit = talus::fit_weibull(values, how_);
    for (const auto& [name, limit] : limits)
      r.limits.push_back(
          {name, limit, lack.empty() ? talus::exceedance(r.fit, values, limit) : talus::Exceedance{}, {}, {}});
    if (weighting_.scale) add_frequencies(r, quantity, crossings_, weighting_);
    if (lack.empty())
      report_.reliability.push_back(std::move(r));
    else
      report_.notes.push_back(lack + counted(r, values) + told_of(r));
  }

 private:
  /// "; 6 of 6 exceed h_i": of values too few for a fit.
  static std::string counted(const talus::io::Reliability& r, const std::vector<double>& values) {
    std::string text;
    for (const talus::io::Reliability::Limit& limit : r.limits)
      if (!values.empty())
        text += "; " + std::to_string(std::ranges::count_if(values, [&](double v) { return v > limit.value; })) +
                " of " + std::to_string(values.size()) + " exceed " + limit.name;
    return text;
  }
  /// Notes on a quantity that has too few values for a fit.
  std::string told_of(const talus::io::Reliability& r) const {
    if (!weighting_.scale) return ", so it is not known how often its design value is exceeded";
    std::string text;
    for (const talus::io::Reliability::Limit& limit : r.limits)
      text += "; by frequency, " + limit.name + " is exceeded by " + talus::io::frequency_text(limit);
    return text;
  }

  BarrierReport& report_;
  std::span<const talus::LineCrossing> crossings_;
  const Weighting& weighting_;
  talus::BootstrapOptions how_;
};

/// A note if the crossings reach an end of the line: the path of the blocks goes on beyond it.
std::optional<std::string> end_note(const talus::io::BarrierWidth& width, double length) {
  const talus::Stretch& s = width.shortest;
  const bool begin = s.from < width.bin;
  const bool end = length - s.to < width.bin;
  if (!begin && !end) return std::nullopt;
  const std::string ends = begin && end ? "both ends" : begin ? "the beginning" : "the end";
  return "blocks cross up to " + ends +
         " of the line, and so probably beyond: width and values hold for the line as it was drawn only (unsafe); draw "
         "a longer one and run again";
}

/// A line where a design asks for more than any net has.
std::optional<std::string> unlikely_note(const BarrierReport& report) {
  double mel = report.design.mel, height = report.design.height;
  for (const talus::io::StretchRow& row : report.stretches)
    if (const auto& design = row.values.design)
      mel = std::max(mel, design->mel), height = std::max(height, design->height);
  std::vector<std::string> texts;
  if (mel > talus::kLargestNetCapacity)
    texts.push_back("MEL of up to " + talus::with_digits(1e-3 * mel, 4) + " kJ is more than any net holds (" +
                    talus::text_of(1e-3 * talus::kLargestNetCapacity) + " kJ)");
  if (height > talus::kHighestNet)
    texts.push_back("h_i of up to " + talus::with_digits(height, 3) + " m is higher than any net (" +
                    talus::text_of(talus::kHighestNet) + " m)");
  if (texts.empty()) return std::nullopt;
  return talus::joined(texts) +
         ", on the line or one of its stretches: place the line elsewhere, or take a dam or a gallery";
}

/// @param all  crossings, also later ones of a block
void add_stretches(BarrierReport& report, std::span<const talus::LineCrossing> all, std::size_t blocks,
                   const talus::DesignBlockRule& rule, const talus::Screen& screen) {
  std::vector<double> parts;
  for (const auto& line : screen.lines) parts.push_back(talus::length_of(line));
  if (const auto note = end_note(*report.width, std::accumulate(parts.begin(), parts.end(), 0.0)))
    report.notes.push_back(*note);
  for (const talus::StretchDesign& s :
       talus::design_stretches(all, talus::stretch_edges(parts, report.longest), rule, report.factors))
    report.stretches.push_back({s, {}});
  if (const auto note = again_note(report, blocks)) report.notes.push_back(*note);
  for (const auto& note : {talus::io::stretch_note(report), talus::io::undesigned_note(report)})
    if (note) report.notes.push_back(*note);
}

/// A line where the volume that was given is far above those of the run, as where a mass was typed.
std::optional<std::string> volume_note(double volume, double largest) {
  constexpr double kFarAbove = 10.0;
  if (!(volume > kFarAbove * largest)) return std::nullopt;
  return "--volume: " + talus::readable(volume) + " m3 is " + talus::readable(volume / largest) +
         " times the largest block that crosses in the run, " + talus::readable(largest) +
         " m3: is it in m3? The speeds and heights are those of the blocks of the run";
}

/// Energy of a block at a speed, without factors [J].
double energy_of(const talus::DesignBlock& block, double speed) {
  return 0.5 * block.volume * block.density * speed * speed;
}

/// "on 13 of 15 stretches with a design, up to 6 times as much": where the block of a stretch, at the speed of its
/// percentile, has more energy than any crossing of it.
std::optional<std::string> stretches_beyond_crossings(const BarrierReport& report) {
  std::size_t designed = 0, above = 0;
  double most = 1.0;
  for (const talus::io::StretchRow& row : report.stretches) {
    const talus::StretchDesign& s = row.values;
    if (!s.design) continue;
    ++designed;
    const double energy = energy_of(s.block, s.design->speed_percentile);
    if (!(energy > s.largest_energy)) continue;
    ++above;
    most = std::max(most, energy / s.largest_energy);
  }
  if (above == 0) return std::nullopt;
  return "on " + std::to_string(above) + " of " + std::to_string(designed) + " stretches with a design, up to " +
         talus::with_digits(most, 2) + " times as much";
}

/// A line where the design block with the percentile of the speed has more energy than any block that crosses: where
/// sizes differ much, the many give the speed and the largest one the mass.
///
/// @param all  crossings, also later ones of a block
std::optional<std::string> energy_note(const BarrierReport& report, std::span<const talus::LineCrossing> all) {
  const double energy = energy_of(report.block, report.design.speed_percentile);
  double largest = 0.0;
  for (const talus::LineCrossing& c : all) largest = std::max(largest, c.energy());
  std::vector<std::string> where;
  if (energy > largest)
    where.push_back("on the line " + talus::with_digits(1e-3 * energy, 4) + " kJ, the crossings at most " +
                    talus::with_digits(1e-3 * largest, 4) + " kJ");
  if (const auto stretches = stretches_beyond_crossings(report)) where.push_back(*stretches);
  if (where.empty()) return std::nullopt;
  return "the largest block at the speed of the percentile has more energy than any crossing (" + where.front() +
         (where.size() > 1 ? "; " + where.back() : "") +
         "): this mass and this speed come in no one fall. Where the block of the design is known, give it by --volume";
}

/// @return  the block of the design
talus::DesignBlockRule add_design(BarrierReport& report, std::span<const talus::LineCrossing> crossings,
                                  const RunSummary& run, const BarrierOptions& o) {
  report.factors = o.factors;
  report.factors.percentile = 0.01 * o.percentile;
  const talus::DesignBlockRule rule{o.volume, o.density.value_or(run.density), run.density};
  report.block_from = o.volume ? "--volume" : "the largest that crosses";
  report.block = rule.of(crossings);
  if (o.volume)
    if (const auto note =
            volume_note(*o.volume, talus::DesignBlockRule{{}, rule.density, rule.rock_density}.of(crossings).volume))
      report.notes.push_back(*note);
  report.design = talus::design_barrier(crossings, report.block, report.factors);
  report.longest = o.stretch.value_or(kLongestStretch);
  return rule;
}

/// The width, with that of the paper's rule. @param crossings  also of blocks that never fall: the rule is of all
/// released blocks
talus::io::BarrierWidth width_by_map(const BarrierReport& report, std::span<const talus::LineCrossing> crossings,
                                     const RunSummary& run) {
  return {.bin = run.cell, .above = talus::stretch_above(crossings, run.cell, run.released, 1.0 - report.containment)};
}

/// Adds how often blocks cross the line and each of its stretches.
void add_crossings_per_year(BarrierReport& report, const Weighting& weighting) {
  for (talus::io::StretchRow& row : report.stretches) row.per_year = weighting.per_year(row.values.sums);
  report.per_year = weighting.per_year(weighting.line);
}

/// The height of a block's centre [m]. @param density  of the rock [kg/m^3]
double centre_of(const talus::LineCrossing& c, double density) {
  return c.height + 0.5 * talus::diameter_of(c.mass / density);
}

/// Adds the values that crossings reach once in some years. @param density  of the rock [kg/m^3]
void add_return_periods(BarrierReport& report, std::span<const talus::LineCrossing> crossings,
                        const Weighting& weighting, std::vector<double> years, double density) {
  if (!weighting.scale) return;
  if (years.empty()) years = talus::HazardMatrix{}.years;
  std::ranges::sort(years);
  years.erase(std::unique(years.begin(), years.end()), years.end());
  const auto once_in = [&](const auto& value_of) {
    return talus::values_once_in(years, crossings, value_of,
                                 [&](const talus::CrossingSums& counted) { return *weighting.per_year(counted); });
  };
  const auto energy = once_in([](const talus::LineCrossing& c) { return 1e-3 * c.energy(); });
  const auto height = once_in([](const talus::LineCrossing& c) { return c.height; });
  const auto centre = once_in([density](const talus::LineCrossing& c) { return centre_of(c, density); });
  const auto speed = once_in([](const talus::LineCrossing& c) { return c.speed; });
  for (std::size_t i = 0; i < years.size(); ++i)
    report.once_in.push_back({years[i], energy[i], height[i], centre[i], speed[i]});
  if (const auto note = talus::io::often_note(report)) report.notes.push_back(*note);
}

/// Weighs the crossings. @return  what each counts, with notes on it and on the run
Weighting add_weighting(std::vector<talus::LineCrossing>& crossings, const CrossingTable& table, const RunSummary& run,
                        const BarrierOptions& o, BarrierReport& report) {
  Weighting weighting = weigh_crossings(crossings, table, {o.folder, o.frequency, o.unweighted});
  refuse_return_periods(o, weighting);
  report.weighting = weighting.text;
  report.frequency = weighting.given;
  if (weighting.scale) report.events_per_year = weighting.scale->total;
  if (const std::string shares = talus::io::class_shares_text(weighting.given); !shares.empty())
    report.notes.push_back(shares);
  for (std::string& note : talus::io::notes_of_run(o.folder, {weighting.given, weighting.scale.has_value(), true}))
    report.notes.push_back(std::move(note));
  for (const auto& note : {talus::io::gap_note(report.without_height),
                           talus::io::left_note(run, left_without_crossing(run, o.folder, table), table.blocks)})
    if (note) report.notes.push_back(*note);
  return weighting;
}

/// Adds the laws of the values and how often they exceed the design. The centre of a block, which passes the net where
/// it is above its top, is half the block higher than the jump: of observed crossings only where all have a mass.
///
/// @param density  of the rock [kg/m^3]
void add_reliability(Exceedances exceedances, const CrossingTable& values, const talus::BarrierDesign& design,
                     double density) {
  using Crossing = talus::LineCrossing;
  std::vector<double> kilojoules, centres;
  for (const double energy : values.energy) kilojoules.push_back(1e-3 * energy);
  if (values.mass.size() == values.count && values.height.size() == values.count)
    for (std::size_t i = 0; i < values.mass.size(); ++i)
      centres.push_back(centre_of({.height = values.height[i], .mass = values.mass[i]}, density));
  exceedances.add({"jump height", "m", &Crossing::height}, values.height, {{"h_i", design.height}});
  exceedances.add({talus::io::kCentre, "m", [density](const Crossing& c) { return centre_of(c, density); }}, centres,
                  {{"h_i", design.height}});
  exceedances.add({"speed", "m/s", &Crossing::speed}, values.speed, {{"v_d", design.speed}});
  exceedances.add({"energy", "kJ", [](const Crossing& c) { return 1e-3 * c.energy(); }}, kilojoules,
                  {{"SEL", design.sel * 1e-3}, {"MEL", design.mel * 1e-3}});
}

BarrierReport report_of(const CrossingTable& crossings, const RunSummary& run, const talus::Screen& screen,
                        const BarrierOptions& o) {
  BarrierReport report;
  const CrossingTable values = o.observed.empty() ? crossings : observed_crossings(o.observed, screen.id);
  if (!o.observed.empty()) report.notes = notes_on_observed(values, o.observed, run);
  report.screen = screen.id;
  report.without_height = without_height(run, screen);
  std::vector<talus::LineCrossing> blocks = first_crossings(crossings, screen);
  Weighting weighting = add_weighting(blocks, crossings, run, o, report);
  report.released = run.released;
  report.crossings = crossings.count;
  report.blocks = crossings.blocks;
  report.containment = 0.01 * o.containment.value_or(kContained);
  if (!run.of_profile) report.width = width_by_map(report, blocks, run);
  const std::vector<talus::LineCrossing> all = with_later_ones(blocks, crossings, screen);
  keep_falling(blocks, o, report, weighting);
  if (report.width) report.width->shortest = talus::shortest_stretch(blocks, report.containment);
  report.values = o.observed.empty() ? "the simulated crossings" : "the observed crossings of " + o.observed;
  const talus::DesignBlockRule rule = add_design(report, blocks, run, o);
  if (!run.of_profile) add_stretches(report, all, blocks.size(), rule, screen);
  if (!o.volume)
    if (const auto note = energy_note(report, all)) report.notes.push_back(*note);
  if (const auto note = unlikely_note(report)) report.notes.push_back(*note);
  add_crossings_per_year(report, weighting);
  add_reliability({report, blocks, weighting, o.seed}, values, report.design, run.density);
  add_return_periods(report, blocks, weighting, o.years, run.density);
  return report;
}

int design(const BarrierOptions& o) {
  check_numbers(o);
  const RunSummary run = talus::io::read_run(o.folder);
  refuse_width_of_profile(run, o);
  const talus::Screen& screen = screen_of(run, o.folder, o.screen);
  talus::io::refuse_unwritable(o.folder);
  const BarrierReport report = report_of(simulated_crossings(run, o.folder, screen), run, screen, o);

  const std::string name = "barrier_" + talus::io::file_name_of(screen.id, screen_ids(run));
  catch_signals();  // from here on: all files or none
  const auto replaced = talus::io::write_barrier(o.folder, name, report, screen, run.crs_wkt);
  if (!run.of_profile) refresh_project(o.folder);  // a profile has no maps
  if (replaced && !o.quiet) say("", *replaced);
  if (o.quiet) return 0;
  say_old_report(o.folder);
  print_text(talus::io::barrier_text(report));
  return 0;
}

}  // namespace

void add_barrier(CLI::App& app, Action& action) {
  const auto o = std::make_shared<BarrierOptions>();
  CLI::App* command = app.add_subcommand("barrier", "Design values of a barrier at a screen of a run");
  with(command->add_option("folder", o->folder, "folder of results that talus run has written, with screens")
           ->required(),
       folder_of_results());
  command->add_option("--screen", o->screen,
                      "id of the line at which the barrier stands; the only one of the run where it is not given");
  with(command->add_option(
           "--observed", o->observed,
           "CSV of observed crossings (as screens.csv or a campaign's passages.csv); the probabilities are of "
           "them, else of the simulated ones"),
       file_of({"csv"}));
  const auto number = [command](const char* name, auto& value, const char* text, const Bounds& bounds,
                                const std::string& standard) {
    with(command->add_option(name, value, text), number_of(bounds, standard));
  };
  const auto add_factor = [&number](const char* name, double& value, const char* text) {
    number(name, value, text, factor(name, ""), talus::text_of(value));
  };
  add_factor("--gTr", o->factors.trajectory, "trajectories: 1.02 for a calibrated model, 1.10 else (default)");
  add_factor("--gDp", o->factors.topography, "topography: 1.02 for a good survey, 1.10 else (default)");
  add_factor("--gVol", o->factors.volume, "volume: 1.02 for a good survey of the blocks, 1.10 else (default)");
  add_factor("--gG", o->factors.density, "density of the rock: 1.00 (default)");
  add_factor("--gE", o->factors.mel, "MEL / SEL: 1.30 as in the paper (default), 1.20 as in UNI 11211-4");
  number("--percentile", o->percentile, "of speed and jump height [%]: 95 (default)", kPercentile,
         talus::text_of(o->percentile));
  number("--volume", o->volume, "of the design block [m3]; the largest that crosses where it is not given", kVolume,
         "");
  number("--density", o->density, "of the design block [kg/m3]; the run's where it is not given", kDensity, "");
  number("--containment", o->containment, "share of the crossings that the width holds [%]: 99 (default)", kContainment,
         talus::text_of(kContained));
  number("--stretch", o->stretch, "longest stretch of the line with a design of its own [m]: 30 (default)", kStretch,
         talus::text_of(kLongestStretch));
  with(command->add_option("--frequency", o->frequency,
                           "another weighting (TOML: [frequency], [features]), as of talus hazard"),
       file_of({"toml"}));
  with(command
           ->add_option("--return-periods", o->years,
                        "for the values that are reached once in so many years, with commas and no spaces: 30,100,300 "
                        "(default)")
           ->delimiter(',')
           ->allow_extra_args(false),
       number_of(kYears, "30,100,300"));
  command->add_flag("--unweighted", o->unweighted, "count every block alike, also where the sources have frequencies");
  add_quiet(*command, o->quiet);
  with(command->add_option("--seed", o->seed, "of the bootstrap: 1 (default)")->check(seed_number()),
       scalar_of("seed"));
  command->footer(
      "Example:\n  talus barrier result --screen road --gTr 1.02 --gDp 1.02 --gVol 1.02\n\n"
      "Writes barrier_ID.json, barrier_ID.csv, barrier_ID_stretches.csv and barrier_ID.gpkg (the stretches on the map) "
      "into the folder. docs/barrier.md explains every value.");
  command->callback([&action, o] { action = [o] { return design(*o); }; });
}
