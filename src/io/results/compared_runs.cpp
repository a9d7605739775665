#include "talus/io/results/compared_runs.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "io/files/json.hpp"
#include "io/files/own_files.hpp"
#include "io/gdal/csv_table.hpp"
#include "io/gdal/map_bands.hpp"
#include "recorded_run.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/gdal/crs.hpp"
#include "talus/io/results/hazard_record.hpp"
#include "talus/io/results/run_record.hpp"

namespace talus::io {

namespace fs = std::filesystem;

/// A folder of results, with its records.
struct ComparedRuns::Run {
  struct Value {
    std::string key, unit, text;
  };
  std::string name;  // of the folder
  fs::path folder;
  ProjectGround ground;
  std::vector<Value> settings;
  std::string status, hazard_status, version, seed, released;
  Json matrix;                  // of the hazard; null without one
  std::set<std::string> files;  // that the records list and that are there

  explicit Run(const std::string& folder_name) : name(folder_name), folder(folder_name) {
    require_results(folder);
    understood(folder / "run.json", "must be as talus run has written it; run the scenario again",
               [&] { read_run_record(read_record(folder / "run.json")); });
    if (fs::exists(folder / "hazard.json"))
      understood(folder / "hazard.json", "must be as talus hazard has written it; run talus hazard again", [&] {
        const Json hazard = read_record(folder / "hazard.json");
        hazard_status = hazard.value("status", "");
        read_weighting(hazard);
        if (hazard.contains("matrix")) matrix = hazard["matrix"];
      });
    for (const char* record : {"run.json", "hazard.json"})
      for (std::string& file : files_of_record(folder / record))
        if (fs::is_regular_file(folder / file)) files.insert(std::move(file));
  }
  void read_run_record(const Json& record) {
    if (is_of_profile(record)) throw InputError("it is of a profile, which has no maps: compare runs over a DEM");
    ground = ground_of_run(folder);
    for (const Json& one : record.at("settings"))
      settings.push_back({one.at("key"), one.value("unit", ""), text_of_json(one.at("value"))});
    status = record.value("status", kComplete);
    version = record.at("version");
    seed = text_of_json(record.at("seed"));
    released = text_of_json(record.at("released"));
  }
  /// Another weighting of the hazard, as settings.
  void read_weighting(const Json& hazard) {
    if (const std::string file = frequency_file_of(folder); !file.empty())
      settings.push_back({"talus hazard --frequency", "", file});
    if (const Json events = hazard.value("events_per_year", Json()); events.is_number())
      settings.push_back({"events of the hazard", "1/year", with_digits(events.get<double>(), 6)});
  }
  static std::string text_of_json(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  }
  std::string setting(const std::string& key) const {
    const auto found = std::ranges::find(settings, key, &Value::key);
    return found == settings.end() ? "" : found->text;
  }
  const InputFile* input(const std::string& role) const {
    const auto found = std::ranges::find(ground.inputs, role, &InputFile::role);
    return found == ground.inputs.end() ? nullptr : &*found;
  }
  bool has(const std::string& raster) const { return files.contains(raster + ".tif"); }
};

namespace {

constexpr std::size_t kMostRuns = 26;  // letters

/// Cells of the grid in words.
std::string grid_text(const ProjectGround& of) {
  return std::to_string(of.columns) + " x " + std::to_string(of.rows) + " cells of " + text_of(of.geo.cell_x) + " x " +
         text_of(of.geo.cell_y) + " m from west " + text_of(of.geo.west) + ", north " + text_of(of.geo.north);
}

bool same_place(const ProjectGround& a, const ProjectGround& b) {
  return a.columns == b.columns && a.rows == b.rows && a.geo.cell_x == b.geo.cell_x && a.geo.cell_y == b.geo.cell_y &&
         a.geo.west == b.geo.west && a.geo.north == b.geo.north;
}

std::string bands_text(const std::vector<Map::Band>& bands) {
  std::vector<std::string> names;
  for (const Map::Band& band : bands) names.push_back("`" + band.name + "` [" + band.unit + "]");
  return listed(names);
}

/// "B - A" of two values as text; empty unless both are numbers.
std::string change_of(const std::vector<std::string>& values) {
  if (values.size() != 2) return "";
  const double a = number_in(values[0]), b = number_in(values[1]);
  return csv_field(b - a);
}

/// A figure from numbers. @param has_change  whether their difference says something
ComparedFigure figure(const char* table, const std::string& name, const std::string& quantity, const std::string& unit,
                      const std::vector<double>& numbers, bool has_change = true) {
  ComparedFigure made{table, name, quantity, unit, {}};
  for (const double number : numbers) made.values.push_back(csv_field(number));
  if (has_change) made.change = change_of(made.values);
  return made;
}

std::vector<double> as_numbers(const std::vector<std::uint64_t>& counts) {
  return {counts.begin(), counts.end()};
}

}  // namespace

const std::vector<std::string>& rasters_by_default() {
  static const std::vector<std::string> names{"hazard_class",      "annual_frequency", "impact_probability",
                                              "reach_probability", "energy",           "jump_height",
                                              "velocity"};
  return names;
}

std::string letter_of_run(std::size_t run) {
  return {static_cast<char>('A' + run)};
}

ComparedRuns::ComparedRuns(std::vector<std::string> folders, const std::vector<std::string>& rasters) {
  if (folders.size() < 2 || folders.size() > kMostRuns)
    throw InputError(std::to_string(folders.size()) + " folders are given, must be 2 to 26");
  for (const std::string& folder : folders) runs_.emplace_back(folder);
  ground_ = runs_.back().ground;
  check_grids();
  note_differences();
  for (const std::string& name : chosen(rasters)) open(name);
}

ComparedRuns::~ComparedRuns() = default;

void ComparedRuns::check_grids() {
  const Run& first = runs_.front();
  for (const Run& run : runs_) {
    if (!same_place(first.ground, run.ground))
      throw InputError(run.name + ": has another grid than " + first.name + " (" + grid_text(run.ground) + "; there " +
                       grid_text(first.ground) + "), must have the same; run both over the same DEM");
    if (!same_plane_system(first.ground.geo.crs_wkt, run.ground.geo.crs_wkt))
      throw InputError(run.name + ": has another coordinate system than " + first.name + " (" +
                       crs_name(run.ground.geo.crs_wkt) + "; there " + crs_name(first.ground.geo.crs_wkt) +
                       "), must have the same; run both over the same DEM");
  }
}

void ComparedRuns::note_differences() {
  const Run& first = runs_.front();
  const auto differs = [&](const auto& value) {
    return std::ranges::any_of(runs_, [&](const Run& run) { return value(run) != value(first); });
  };
  for (const Run& run : runs_)
    for (const std::string& status : {run.status, run.hazard_status})
      if (!status.empty() && status != kComplete)
        notes_.push_back(run.name + ": has results with the status \"" + status + "\": do not use the comparison");
  for (const InputFile& input : first.ground.inputs) {
    const auto path = [&](const Run& run) { return run.input(input.role) ? run.input(input.role)->path : ""; };
    const auto sum = [&](const Run& run) { return run.input(input.role) ? run.input(input.role)->sha256 : ""; };
    if (differs(sum) && (input.role == "dem" || !differs(path)))
      notes_.push_back("the runs have read different contents of the input `" + input.role + "`" +
                       (input.role == "dem" ? ": changes come from the terrain, too" : ", from files of one name"));
  }
  if (differs([](const Run& run) { return run.version; }))
    notes_.emplace_back("the runs were made by different versions of Talus: changes may come from these");
  if (differs([](const Run& run) { return run.released; }))
    notes_.emplace_back(
        "the runs have released different numbers of blocks: maxima and reached cells grow with the number, and reach "
        "probabilities fall");
  for (const Run& run : runs_)
    if (&run != &first && fs::equivalent(run.folder, first.folder))
      notes_.push_back(run.name + ": is the same folder as " + first.name + ": is another one meant?");
  notes_.emplace_back(
      differs([](const Run& run) { return run.seed; })
          ? "the runs have different seeds: part of each change is chance"
          : "the runs have the same seed and share random numbers: chance is mostly smaller than the bounds say");
  if (runs_.size() == 2)
    notes_.emplace_back(
        "surely worse: the 95 % bounds of the two runs do not overlap (band `bounds apart`); by chance alone in less "
        "than 1 % of the cells if both runs have as many blocks, else in at most 5 %");
}

/// The names of the rasters to compare, in order. Notes those of the default that only some runs have.
std::vector<std::string> ComparedRuns::chosen(const std::vector<std::string>& asked) {
  std::vector<std::string> found, known;
  for (const std::string& file : runs_.front().files)
    if (file.ends_with(".tif") && compared_raster(file.substr(0, file.size() - 4)))
      known.push_back(file.substr(0, file.size() - 4));
  for (const std::string& name : asked.empty() ? rasters_by_default() : asked) {
    if (!asked.empty() && !compared_raster(name))
      throw InputError("--rasters: '" + name + "' is no raster that can be compared" + known_names(name, known));
    std::vector<std::string> without, with;
    for (const Run& run : runs_) (run.has(name) ? with : without).push_back(run.name);
    if (without.empty()) {
      if (std::ranges::find(found, name) == found.end()) found.push_back(name);
    } else if (!asked.empty()) {
      throw InputError(without.front() + ": has no " + name + ".tif, must have it for --rasters " + name);
    } else if (!with.empty()) {
      notes_.push_back(name + ".tif is not compared: " + joined(without) +
                       " has none (talus run or talus hazard makes it)");
    }
  }
  if (found.empty()) throw InputError(runs_.front().name + ": has no raster that all folders have");
  return found;
}

void ComparedRuns::open(const std::string& name) {
  Opened opened{*compared_raster(name), {}};
  for (const Run& run : runs_)
    opened.files.push_back(
        std::make_unique<MapBands>((run.folder / (name + ".tif")).string(), run.ground.columns, run.ground.rows));
  const MapBands& first = *opened.files.front();
  const std::string there = " than that of " + runs_.front().name;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const MapBands& file = *opened.files[i];
    const auto same = [](const Map::Band& a, const Map::Band& b) { return a.name == b.name && a.unit == b.unit; };
    if (!std::ranges::equal(file.bands(), first.bands(), same))
      throw InputError(file.path() + ": has other bands" + there + " (" + bands_text(file.bands()) + "; there " +
                       bands_text(first.bands()) + "), must have the same; give both runs the same thresholds, and " +
                       "talus hazard the same options");
    if (file.title() != first.title())
      throw InputError(file.path() + ": has another title" + there + " (\"" + file.title() + "\"; there \"" +
                       first.title() + "\"), must have the same; give both runs the same options");
    if (name == "hazard_class" && runs_[i].matrix != runs_.front().matrix)
      throw InputError(file.path() + ": has classes of another matrix" + there +
                       ", must have those of the same; give talus hazard the same --matrix");
  }
  Map& map = opened.raster.map;
  map.bands = first.bands();
  map.title = first.title();
  if (name == "hazard_class")
    map.classes = understood(runs_.front().folder / "hazard.json", "run talus hazard again",
                             [&] { return runs_.front().matrix.at("names").get<std::vector<std::string>>(); });
  opened_.push_back(std::move(opened));
}

std::vector<std::vector<double>> ComparedRuns::Opened::read(const CellWindow& window) const {
  std::vector<std::vector<double>> values;
  for (const auto& file : files) values.push_back(file->read(window));
  return values;
}

std::vector<Map> ComparedRuns::maps() const {
  std::vector<Map> maps;
  for (const Opened& opened : opened_) {
    maps.push_back(worst_map(opened.raster, runs_.size()));
    maps.back().fill = [&opened](const CellWindow& window, std::span<double> values) {
      take_worst(opened.raster, opened.read(window), values);
    };
    if (runs_.size() != 2) continue;
    maps.push_back(change_map(opened.raster));
    maps.back().fill = [&opened](const CellWindow& window, std::span<double> values) {
      take_change(opened.raster, opened.read(window), values);
    };
  }
  return maps;
}

void ComparedRuns::add_settings(std::vector<ComparedFigure>& figures) const {
  std::vector<ComparedFigure> all;  // in the order of the records
  for (const Run& run : runs_)
    for (const Run::Value& setting : run.settings)
      if (std::ranges::find(all, setting.key, &ComparedFigure::name) == all.end())
        all.push_back({"setting", setting.key, "", setting.unit, {}});
  for (ComparedFigure& row : all) {
    for (const Run& run : runs_) row.values.push_back(run.setting(row.name));
    if (std::ranges::adjacent_find(row.values, std::not_equal_to()) != row.values.end())
      figures.push_back(std::move(row));
  }
}

void ComparedRuns::add_cells(std::size_t raster, const std::function<bool(double share)>& proceed,
                             std::vector<ComparedFigure>& figures) const {
  constexpr int kSide = 256;  // of the tiles of the files
  const Opened& opened = opened_[raster];
  ComparedCells cells(runs_.size());
  for (int top = ground_.rows; top > 0; top -= kSide) {
    const double done = 1.0 - top / static_cast<double>(ground_.rows);
    if (!proceed((static_cast<double>(raster) + done) / static_cast<double>(opened_.size()))) return;
    for (int left = 0; left < ground_.columns; left += kSide) {
      const int row = std::max(0, top - kSide);
      cells.add(opened.raster, opened.read({left, row, std::min(kSide, ground_.columns - left), top - row}));
    }
  }
  const Map& map = opened.raster.map;
  const Map::Band& band = map.bands[opened.raster.shown_band()];
  std::vector<double> means;
  for (std::size_t run = 0; run < runs_.size(); ++run) means.push_back(cells.mean(run));
  figures.push_back(figure("raster", map.name, "cells only this run reaches", "count", as_numbers(cells.alone), false));
  figures.push_back(figure("raster", map.name, "cells all runs reach", "count",
                           std::vector(runs_.size(), static_cast<double>(cells.common)), false));
  figures.push_back(
      figure("raster", map.name, "mean of " + band.name.substr(0, band.name.find(" (")) + " there", band.unit, means));
  if (runs_.size() == 2 && opened.raster.has_bounds())
    figures.push_back(
        figure("raster", map.name, "cells where this run is surely worse", "count", as_numbers(cells.worse), false));
}

void ComparedRuns::add_screens(std::vector<ComparedFigure>& figures) const {
  struct Wanted {
    const char *quantity, *column, *text, *unit;
  };
  constexpr Wanted kWanted[] = {{"speed", "share_of_released", "share of the released blocks that cross", "1"},
                                {"energy", "p95", "translational energy, P95 of the crossings", "kJ"},
                                {"jump height", "p95", "jump height, P95 of the crossings", "m"}};
  std::vector<ComparedFigure> rows;
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    const fs::path file = runs_[run].folder / "screens_summary.csv";
    if (!runs_[run].files.contains("screens_summary.csv")) continue;
    const CsvTable table(file.string(), {}, {"screen", "quantity", "share_of_released", "p95"});
    for (const CsvTable::Row& line : table.rows())
      for (const Wanted& wanted : kWanted) {
        if (table.text(line, "quantity") != wanted.quantity) continue;
        const std::string& screen = table.text(line, "screen");
        auto row = std::ranges::find_if(
            rows, [&](const ComparedFigure& one) { return one.name == screen && one.quantity == wanted.text; });
        if (row == rows.end())
          row = rows.insert(rows.end(),
                            {"screen", screen, wanted.text, wanted.unit, std::vector<std::string>(runs_.size())});
        row->values[run] = table.text(line, wanted.column);
        row->change = change_of(row->values);
      }
  }
  figures.insert(figures.end(), rows.begin(), rows.end());
}

std::vector<ComparedFigure> ComparedRuns::figures(const std::function<bool(double share)>& proceed) const {
  std::vector<ComparedFigure> figures;
  ComparedFigure folders{"run", "folder", "", "", {}};
  for (const Run& run : runs_) folders.values.push_back(run.name);
  figures.push_back(std::move(folders));
  add_settings(figures);
  for (std::size_t raster = 0; raster < opened_.size(); ++raster) add_cells(raster, proceed, figures);
  add_screens(figures);
  return figures;
}

}  // namespace talus::io
