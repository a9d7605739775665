#include "report_maps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/files/checksum.hpp"
#include "packed_map.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/io/results/style.hpp"
#include "talus/products/energy_words.hpp"
#include "talus/products/hazard_table.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

/// A raster that a page shows where it is there, in this order.
struct Shown {
  const char *begins, *title;
  bool in_print;
};
constexpr Shown kShown[] = {{"hazard_class", "Hazard class", true},
                            {"impact_probability", "Impact probability", true},
                            {"energy", "Energy", true},
                            {"energy_total", "Energy with rotation", true},
                            {"jump_height", "Jump height", true},
                            {"velocity", "Speed", true},
                            {"deposits", "Deposits", true},
                            {"release", "Released blocks", true},
                            {"annual_frequency", "Annual frequency", true},
                            {"return_period_", "Return period", true},
                            {"intensity_T", "Energy", true},
                            {"reach_probability", "Reach probability", false},
                            {"passages", "Passages", false},
                            {"trapped", "Trapped", false},
                            {"exits", "Paths that leave the DEM", false}};
constexpr std::size_t kMostMaps = 24;

/// "30" of "return_period_30".
std::string rest_of(const std::string& name, const Shown& shown) {
  return name.substr(std::string(shown.begins).size());
}

bool is_shown_as(const std::string& name, const Shown& shown) {
  const std::string begins = shown.begins;
  return begins.ends_with('_') || begins.ends_with('T') ? name.starts_with(begins) && name.size() < begins.size() + 12
                                                        : name == begins;
}

std::string title_of(const std::string& name, const Shown& shown, const std::string& band, const RunFacts& run) {
  const std::string title = shown.title, rest = rest_of(name, shown);
  const std::string of_energy = title + ", " + energy_words(run.count_rotation).name;
  if (name.starts_with("return_period_")) return of_energy + " > " + rest + " kJ";
  if (name.starts_with("intensity_T")) return of_energy + " once in " + rest + " years";
  if (name == "hazard_class") return of_energy;
  const bool quantity = band == "mean" || band == "maximum" || (band.size() == 3 && band.starts_with('P'));
  const bool both = run.count_rotation || std::ranges::count(run.files, "energy_total.tif") > 0;
  const std::string remark = name == "energy" && both ? energy_words(false).remark : "";
  return (quantity ? title + ", " + shortened(band, 20) : title) + remark;
}

/// The rasters of a kind in the folder, by the number in their name.
std::vector<std::string> names_in(const fs::path& folder, const Shown& shown) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".tif" && is_shown_as(entry.path().stem().string(), shown))
      names.push_back(entry.path().stem().string());
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);  // 30 before 300
  });
  return names;
}

/// Throws InputError if a raster is not on the grid of the run.
void check_grid(const fs::path& file, const MapRaster& raster, const RecordedGrid& grid) {
  if (raster.columns() == grid.columns && raster.rows() == grid.rows) return;
  throw InputError(file.string() + ": has " + std::to_string(raster.columns()) + " x " + std::to_string(raster.rows()) +
                   " cells, must have those of the run, " + std::to_string(grid.columns) + " x " +
                   std::to_string(grid.rows));
}

/// The cells that something passes, with the objects and a rim; the whole grid where nothing is known.
MapWindow window_of(const fs::path& folder, const NamedFiles& named, const RecordedGrid& grid,
                    const Outlines& objects) {
  MapWindow window{0, 0, grid.columns, grid.rows, 1};
  const fs::path passages = folder / "impact_probability.tif";
  if (named.contains(passages.filename()) && fs::exists(passages)) {
    const MapRaster raster(passages.string(), 1);
    check_grid(passages, raster, grid);
    window = raster.positive_cells().value_or(window);
  }
  double left = window.column, top = window.row, right = left + window.columns, bottom = top + window.rows;
  for (const Outline& object : objects.list)
    for (const Eigen::Vector2d& place : object.places) {
      left = std::min(left, (place.x() - grid.west) / grid.cell_x);
      right = std::max(right, (place.x() - grid.west) / grid.cell_x);
      top = std::min(top, (grid.north - place.y()) / grid.cell_y);
      bottom = std::max(bottom, (grid.north - place.y()) / grid.cell_y);
    }
  const double rim = 2.0 + 0.04 * std::max(right - left, bottom - top);
  const auto cell = [](double place, int most) { return static_cast<int>(std::clamp<double>(place, 0.0, most)); };
  window.column = cell(std::floor(left - rim), grid.columns);
  window.row = cell(std::floor(top - rim), grid.rows);
  window.columns = std::max(1, cell(std::ceil(right + rim), grid.columns) - window.column);
  window.rows = std::max(1, cell(std::ceil(bottom + rim), grid.rows) - window.row);
  window.side = (std::max(window.columns, window.rows) + kLongestMap - 1) / kLongestMap;
  return window;
}

/// The relief, if the DEM is there and is the one of the run.
void add_relief(const RunFacts& run, MapSheet& sheet) {
  if (run.of_profile) return;  // it has no maps
  const InputFile* const dem = run.input("dem");
  const auto leave_out = [&](const std::string& why) {
    sheet.relief_note = "No relief under the maps: the DEM " + why + ".";
  };
  if (dem == nullptr) return leave_out("is not in the record of the run");
  try {
    if (const std::string now = sha256_of_file(dem->path); now.empty() || dem->sha256.empty())
      return leave_out("is no longer where it was, " + shortened(dem->path, 300));
    else if (now != dem->sha256)
      return leave_out("has changed since the run (its checksum is another), " + shortened(dem->path, 300));
    const MapRaster raster(dem->path, 1);
    check_grid(dem->path, raster, run.grid);
    sheet.copyright = shortened(raster.metadata("TIFFTAG_COPYRIGHT"), 200);
    const std::vector<double> heights = raster.pixels(sheet.window, PixelValue::Mean);
    sheet.relief = relief_of(heights, sheet.window.width(), sheet.pixel_x, sheet.pixel_y);
  } catch (const InputError& error) {
    leave_out("cannot be read: " + shortened(error.what(), 300));
  }
}

/// A raster as a map; nothing with a note if it has no style that can be drawn.
void add_map(const fs::path& folder, const std::string& name, const Shown& shown, const RunFacts& run,
             MapSheet& sheet) {
  const fs::path file = folder / (name + ".tif");
  const auto style = read_map_style(folder / (name + ".qml"));
  if (!style) {
    sheet.notes.push_back(name + ".tif: has no style with classes beside it (" + name + ".qml), and is not shown");
    return;
  }
  const MapRaster raster(file.string(), style->band);
  check_grid(file, raster, run.grid);
  ReportMap map{name, title_of(name, shown, raster.band_name(), run), shortened(raster.unit(), 20), *style, {}, {}};
  map.file = name + ".tif";
  map.in_print = shown.in_print;
  map.smallest = name.starts_with("return_period_");
  map.classes_only = name == "hazard_class";
  std::vector<double> values = raster.pixels(sheet.window, map.smallest ? PixelValue::Smallest : PixelValue::Largest);
  for (const double value : values) map.largest = std::max(map.largest, std::isnan(value) ? 0.0 : value);
  map.picture = picture_of(values, sheet.window.width(), map.style);
  map.values = packed_values(values);
  if (name == "release")
    for (const double value : values) sheet.sources.push_back(value > 0.0 ? 1 : 0);
  if ((name == "trapped" || name == "exits") && !(map.largest > 0.0)) return;  // an empty map says nothing
  sheet.maps.push_back(std::move(map));
}

const Map::Mark& mark_of_classes(const std::string& band) {
  for (const HazardRaster& raster : hazard_rasters())
    for (const Map::Mark& mark : raster.map.marks)
      if (mark.band == band) return mark;
  throw std::logic_error("no mark " + band);
}

MapClass class_of_mark(const Map::Mark& mark) {
  const auto [red, green, blue] = channels_of(mark.colour);
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  return {1.0, mark.label, {byte(red), byte(green), byte(blue)}};
}

/// Where paths leave the map: drawn over all maps.
void add_cut_short(const fs::path& folder, const RunFacts& run, MapSheet& sheet) {
  const fs::path file = folder / "hazard_class.tif";
  const MapRaster cut(file.string(), std::string("cut short"));
  check_grid(file, cut, run.grid);
  for (const double value : cut.pixels(sheet.window, PixelValue::Largest)) sheet.cut_short.push_back(value > 0.0);
  if (std::ranges::count(sheet.cut_short, 1) == 0) sheet.cut_short.clear();
  sheet.cut = class_of_mark(mark_of_classes("cut short"));
}

/// Where the classes at the two bounds of the frequency differ: a map of its own.
void add_undecided(const fs::path& folder, const RunFacts& run, MapSheet& sheet) {
  const fs::path file = folder / "hazard_class.tif";
  const MapRaster classes(file.string(), std::string("class")), undecided(file.string(), std::string("undecided"));
  check_grid(file, undecided, run.grid);
  const std::vector<double> of_class = classes.pixels(sheet.window, PixelValue::Largest);
  std::vector<double> values = undecided.pixels(sheet.window, PixelValue::Largest);
  double open = 0.0, all = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(of_class[i] > 0.0 || values[i] > 0.0)) values[i] = kNotGiven;
    if (!std::isnan(values[i])) open += values[i], all += 1.0;
  }
  if (all > 0.0) sheet.undecided = open / all;
  if (sheet.maps.size() == kMostMaps) {
    sheet.notes.push_back("Class not decided: is not shown, as there are " + std::to_string(kMostMaps) +
                          " maps already");
    return;
  }
  ReportMap map{"hazard_class_undecided", "Class not decided", "1", {}, {}, {}};
  map.file = "hazard_class.tif, band undecided";
  map.style = {
      undecided.band(), true, {{0.0, "decided", {200, 200, 200}}, class_of_mark(mark_of_classes("undecided"))}};
  map.classes_only = true;
  map.in_print = open > 0.0;
  map.picture = picture_of(values, sheet.window.width(), map.style);
  map.values = packed_values(values);
  sheet.maps.push_back(std::move(map));
}

}  // namespace

MapSheet read_sheet(const fs::path& folder, const RunFacts& run, const NamedFiles& named) {
  constexpr std::size_t kMostPlaces = 50'000;
  MapSheet sheet;
  if (const fs::path objects = folder / "objects.gpkg"; named.contains(objects.filename()) && fs::exists(objects))
    sheet.objects = read_outlines(objects.string(), "objects", {"object", "name"}, kMostPlaces);  // earlier runs: name
  if (sheet.objects.cut) sheet.notes.push_back("objects.gpkg: has more objects than are drawn");
  sheet.window = window_of(folder, named, run.grid, sheet.objects);
  const MapWindow& window = sheet.window;
  sheet.west = run.grid.west + window.column * run.grid.cell_x;
  sheet.north = run.grid.north - window.row * run.grid.cell_y;
  sheet.pixel_x = window.side * run.grid.cell_x;
  sheet.pixel_y = window.side * run.grid.cell_y;
  add_relief(run, sheet);
  sheet.notes.insert(sheet.notes.end(), named.notes().begin(), named.notes().end());
  for (const Shown& shown : kShown)
    for (const std::string& name : names_in(folder, shown)) {
      if (!named.contains(name + ".tif")) continue;
      if (sheet.maps.size() < kMostMaps)
        add_map(folder, name, shown, run, sheet);
      else
        sheet.notes.push_back(name + ".tif: is not shown, as there are " + std::to_string(kMostMaps) + " maps already");
    }
  if (const std::string classes = "hazard_class.tif"; named.contains(classes) && fs::exists(folder / classes)) {
    add_undecided(folder, run, sheet);
    add_cut_short(folder, run, sheet);
  }
  return sheet;
}

}  // namespace talus::io
