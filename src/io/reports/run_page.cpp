#include "talus/io/reports/run_page.hpp"

#include <algorithm>
#include <charconv>
#include <ctime>

#include "io/files/own_files.hpp"
#include "page_frame.hpp"
#include "report_barriers.hpp"
#include "report_checks.hpp"
#include "report_facts.hpp"
#include "report_map_page.hpp"
#include "report_objects.hpp"
#include "report_profile.hpp"
#include "run_page_script.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/files/staged_path.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/products/energy_words.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

/// All that a page shows.
struct RunReport {
  RunFacts run;
  std::optional<HazardFacts> hazard;
  MapSheet sheet;
  std::optional<ProfilePart> profile;  // of a run on one
  ScreensPart screens;
  std::vector<BarrierPart> barriers;
  ObjectsPart objects;
  std::optional<FitPart> fit;
  bool has_frequencies = false;

  CheckedRun checked() const { return {run, hazard, sheet, screens, fit, has_frequencies}; }
};

RunReport read_report(const fs::path& folder) {
  RunReport report;
  report.run = read_facts(folder);
  report.hazard = read_hazard_facts(folder, report.run);
  const NamedFiles named(folder, report.run, report.hazard);
  report.sheet = read_sheet(folder, report.run, named);
  if (report.run.of_profile)
    report.profile =
        read_profile_part(folder, report.run.end("stopped") + report.run.end("trapped") + report.run.end("caught"));
  if (named.contains("screens_summary.csv")) report.screens = read_screens_part(folder);
  report.barriers = read_barrier_parts(folder, report.hazard);
  if (named.contains("objects.csv")) report.objects = read_objects_part(folder, report.run.count_rotation);
  report.fit = read_fit_part(report.run);
  report.has_frequencies = fs::exists(folder / kHazardFile);
  return report;
}

Markup warnings_html(const RunReport& report) {
  std::vector<std::string> warnings = all_warnings(report.run, report.hazard);
  const auto lowers_the_hazard = [](const std::string& warning) {
    return says_maps_end_early(warning) || warning.find("the maps do not show how far") != std::string::npos ||
           warning.find("(unsafe)") != std::string::npos;
  };
  std::stable_partition(warnings.begin(), warnings.end(), lowers_the_hazard);  // these first
  if (warnings.empty()) return "<p>The run gave no warnings.</p>\n"_html;
  Markup html = "<h3>Warnings</h3>\n<ul>\n"_html;
  for (const std::string& warning : warnings) html += "<li class='look'>"_html + warning + "</li>\n";
  return html + "</ul>\n";
}

Markup line(const std::string& name, const std::string& value) {
  return value.empty() ? Markup() : "<tr><th>"_html + name + "</th><td class='b'>" + value + "</td></tr>\n";
}

std::string ends_text(const RunFacts& run) {
  std::string text;
  for (const auto& [end, count] : run.ends) text += (text.empty() ? "" : ", ") + end + " " + grouped(count);
  return text;
}

std::string energy_line_text(const RunFacts& run) {
  if (!run.energy_line) return "";
  const auto& [least, p5, p50] = *run.energy_line;
  return "least " + with_digits(least, 4) + ", P5 " + with_digits(p5, 4) + ", P50 " + with_digits(p50, 4) + " deg, " +
         energy_lines_of(static_cast<std::uint64_t>(run.energy_line_stops), run.energy_line_farther);
}

Markup run_html(const RunReport& report, const std::string& attribution) {
  const RunFacts& run = report.run;
  const RecordedGrid& grid = run.grid;
  const std::string blocks =
      grouped(run.released) + " blocks" +
      (run.of_profile ? std::string()
                      : " from " + grouped(run.source_cells) + " source cells, " + grouped(run.per_source) + " each") +
      (run.rounds > 0.0 ? ", in " + grouped(run.rounds) + (run.rounds == 1.0 ? " round" : " rounds") : std::string());
  return "<h2>What was run</h2>\n<table>\n"_html + line("program", "talus " + run.version) +
         line("command", run.command) + line("hazard", report.hazard ? report.hazard->command : "") +
         line("run.json written on", run.written) + line("status", run.status) + line("released", blocks) +
         line("how they ended", ends_text(run)) +
         line("paths", grouped(run.kilometres) + " km, " + grouped(run.impacts) + " impacts" +
                           (run.of_profile ? "" : ", " + grouped(run.touched_cells) + " cells touched")) +
         line("energy line of those that stopped", energy_line_text(run)) +
         line("terrain", run.of_profile
                             ? grouped(grid.columns) + " steps of " + with_digits(grid.cell_x, 6) + " m"
                             : grouped(grid.columns) + " x " + grouped(grid.rows) + " cells of " +
                                   with_digits(grid.cell_x, 6) + " x " + with_digits(grid.cell_y, 6) + " m") +
         line("coordinate system", grid.crs) + line("attribution", attribution) + line("plan", run.plan) +
         "</table>\n" + warnings_html(report);
}

Markup inputs_html(const RunFacts& run) {
  Markup html = "<h3>Inputs</h3>\n<div class='wide'><table><tr><th>role</th><th>file</th><th>SHA-256</th></tr>\n"_html;
  for (const InputFile& input : run.inputs)
    html += "<tr><td>"_html + input.role + "</td><td class='b'>" + input.path + "</td><td class='b'>" + input.sha256 +
            "</td></tr>\n";
  html += "</table></div>\n";
  for (const std::string& note : run.notes) html += "<p class='note'>"_html + note + "</p>\n";
  return html;
}

Markup settings_html(const RunFacts& run) {
  const auto table = [&](auto wanted) {
    Markup rows = "<table><tr><th>setting</th><th>value</th><th>unit</th><th>from</th></tr>\n"_html;
    for (const RecordedSetting& s : run.settings)
      if (wanted(s))
        rows += "<tr><td class='b'>"_html + s.key + "</td><td class='b'>" + s.value + "</td><td>" + s.unit +
                "</td><td class='b'>" + s.source + "</td></tr>\n";
    return rows + "</table>\n";
  };
  const auto given = [](const RecordedSetting& s) { return !s.is_default() && !s.is_of_preset(); };
  return "<h3>Settings that were given</h3>\n"_html + table(given) +
         "<details open><summary>Settings of presets and defaults</summary>\n" +
         table([&](const RecordedSetting& s) { return !given(s); }) + "</details>\n";
}

/// "30 to 100 years": the class of that number between limits.
std::string between(const std::vector<double>& limits, std::size_t number, const std::string& unit) {
  if (number == 0) return "up to " + readable(limits.front()) + unit;
  if (number >= limits.size()) return "above " + readable(limits.back()) + unit;
  return readable(limits[number - 1]) + " to " + readable(limits[number]) + unit;
}

/// The matrix of the classes of hazard.
Markup classes_html(const HazardFacts& hazard, bool with_rotation) {
  if (hazard.classes.empty() || hazard.energies.empty() || hazard.years.empty()) return {};
  Markup html =
      "<h3>Classes of hazard</h3>\n<p class='before'>For "_html + hazard.object +
      ", by how often it is hit with more than the energy of a row: that with which blocks pass the place. The highest "
      "class of the rows counts. A table of objects takes the largest energy within each outline, which is "
      "higher.</p>\n"
      "<table class='whole'><tr><th>";
  html += energy_words(with_rotation).name;
  html += ", return period</th>";
  for (std::size_t k = 0; k < hazard.classes.front().size(); ++k)
    html += "<th>"_html + between(hazard.years, k, " years") + "</th>";
  html += "</tr>\n";
  for (std::size_t i = 0; i < hazard.classes.size(); ++i) {
    html += "<tr><th>"_html + (i == 0 ? "any" : "more than " + readable(hazard.energies[i - 1]) + " kJ") + "</th>";
    for (const std::string& name : hazard.classes[i]) html += "<td>"_html + name + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

Markup maps_html(const RunReport& report, const MapImprint& imprint) {
  const MapSheet& sheet = report.sheet;
  Markup html = "<h2>Maps</h2>\n"_html;
  if (sheet.window.side > 1 && !sheet.maps.empty())
    html += "<p>The maps show the part of the terrain that something passes. A pixel is "_html +
            with_digits(sheet.pixel_x, 4) + " m wide and holds " + std::to_string(sheet.window.side) + " x " +
            std::to_string(sheet.window.side) +
            " cells: it shows their largest value (of return periods the smallest), so that reached areas look larger "
            "than they are.</p>\n";
  if (!sheet.relief_note.empty()) html += "<p class='act'>"_html + sheet.relief_note + "</p>\n";
  for (const std::string& note : sheet.notes) html += "<p class='note'>"_html + note + "</p>\n";
  if (report.hazard) html += classes_html(*report.hazard, report.run.count_rotation);
  if (sheet.maps.empty()) return html + "<p>The folder has no maps.</p>\n";
  return html + map_store(sheet, report.run, imprint) + map_viewer(sheet) + map_figures(sheet, imprint);
}

/// The time that the environment states for repeatable builds, else the present [s since 1970, UTC].
std::time_t time_of_page() {
  constexpr std::int64_t kMost = 253'402'300'799;  // the end of the year 9999
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");
  if (given == nullptr) return std::time(nullptr);
  const std::string_view text = given;
  std::int64_t seconds = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 0 || seconds > kMost)
    throw InputError("SOURCE_DATE_EPOCH = '" + std::string(text) +
                     "' in the environment: must be a whole number of seconds since 1970, from 0 to " +
                     std::to_string(kMost) + "; unset it for the date of today");
  return static_cast<std::time_t>(seconds);
}

}  // namespace

std::string run_page(const RunPageRequest& request) {
  const RunReport report = read_report(request.folder);
  const std::string attribution = request.attribution.empty() ? report.sheet.copyright : request.attribution;
  const MapImprint imprint{report.run.grid.crs, report.run.written, attribution};
  const fs::path folder = fs::absolute(request.folder).lexically_normal();
  const std::string name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  const PageFrame frame{"report", request.title.empty() ? "Rock fall: " + name : request.title,
                        "page of " + day_text(time_of_page()) + ", run.json written on " + report.run.written +
                            ", plan " + report.run.plan,
                        report.sheet.maps.empty() ? Markup() : run_page_script()};
  const Markup places = report.profile ? profile_html(*report.profile) : maps_html(report, imprint);
  const Markup body = run_html(report, attribution) + places + standing_html(report.run) +
                      screens_html(report.screens) + barriers_html(report.barriers) +
                      objects_html(report.objects, report.run.pieces > 0.0,
                                   report.hazard ? report.hazard->class_names : std::vector<std::string>()) +
                      fit_html(report.fit) + assumptions_html(report.checked()) +
                      checks_html(checks_of(report.checked())) + "<h2>Record</h2>\n" + inputs_html(report.run) +
                      settings_html(report.run);
  return page_of(frame, body);
}

RunPageFile::RunPageFile(const fs::path& file, bool overwrite, const fs::path& folder) : file_(behind_links(file)) {
  require_results(folder);
  refuse_dangling_link(file);
  std::error_code none;
  if (fs::exists(file, none)) {
    if (!overwrite)
      throw InputError(file.string() + ": is there already; give --overwrite to replace it, or another name by -o");
    if (!is_run_page(file))
      throw InputError(file.string() +
                       ": is there and no page of talus report, so it is not replaced; give another name by -o");
  }
  parents_.make(file_.parent_path());
  refuse_unwritable(folder_written(file));
}

void RunPageFile::write(const std::string& page) const {
  replace_text(file_, page);
}

}  // namespace talus::io
