#include "talus/io/results/hazard_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "hazard_stream.hpp"
#include "io/files/json.hpp"
#include "io/files/own_files.hpp"
#include "talus/base/error.hpp"
#include "talus/base/version.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {
namespace {

/// Bits of the byte of a cell.
constexpr unsigned kTerrain = 1, kTouched = 2, kExit = 4;

constexpr const char* kMark = "talus-hazard";
constexpr int kFormat = 3, kRotationFormat = 4;  // 4: energies with rotation, which earlier versions must not read
constexpr std::size_t kMostThresholds = 32;
constexpr double kMostPerByte = 1040.0;  // bytes that one byte of a gzip file can hold

Json json_of(const LoadedScenario& loaded, const HazardRules& rules, std::int64_t left_weight) {
  const Grid& grid = loaded.scenario.surface.grid();
  const WeightScale& scale = rules.scale;
  return {{"version", version()},
          {"plan", plan_checksum(loaded)},
          {"columns", grid.columns},
          {"rows", grid.rows},
          {"cell_x", grid.cell_x},
          {"cell_y", grid.cell_y},
          {"west", loaded.geo.west},
          {"north", loaded.geo.north},
          {"crs_wkt", loaded.geo.crs_wkt},
          {"energy_thresholds", rules.bins.thresholds()},
          {"unit", scale.unit},
          {"square_unit", scale.square_unit},
          {"total", scale.total},
          {"largest", scale.largest},
          {"trajectories", scale.trajectories},
          {"equal", scale.equal},
          {"room", scale.room},
          {"left", left_weight},
          {"largest_diameter", scale.largest_diameter},
          {"passages_below", loaded.scenario.output.passages_below}};
}

/// Whether the numbers of a header are some that a run can write.
bool is_possible(const HazardHeader& header) {
  const auto within = [](const char* key, double value) { return !fault_of(bounds_of(key), value); };
  const auto& thresholds = header.rules.bins.thresholds();
  const WeightScale& scale = header.rules.scale;
  return within("dem.cell", header.grid.cell_x) && within("dem.cell", header.grid.cell_y) &&
         std::isfinite(header.geo.west) && std::isfinite(header.geo.north) && thresholds.size() <= kMostThresholds &&
         std::ranges::is_sorted(thresholds) &&
         std::ranges::all_of(thresholds, [&](double kj) { return within("output.energy_thresholds", kj); }) &&
         scale.unit > 0.0 && scale.square_unit > 0.0 && scale.total > 0.0 && std::isfinite(scale.total) &&
         scale.largest > 0 && scale.trajectories > 0 && scale.largest_diameter >= 0.0 &&
         std::isfinite(scale.largest_diameter) && scale.room >= 1.0 && std::isfinite(scale.room) &&
         header.left_weight >= 0 && within("output.passages_below", header.passages_below);
}

HazardHeader header_of(const std::string& text) {
  constexpr std::int64_t kMostCells = std::numeric_limits<int>::max();
  const Json json = parsed_record(text);
  HazardHeader header{
      json.at("version"), json.at("plan"),          {}, {}, {EnergyBins(json.at("energy_thresholds")), {}},
      json.at("left"),    json.at("passages_below")};
  Grid& grid = header.grid;
  grid.columns = static_cast<int>(whole_number(json.at("columns"), 1, kMostCells));
  grid.rows = static_cast<int>(whole_number(json.at("rows"), 1, kMostCells));
  grid.cell_x = json.at("cell_x");
  grid.cell_y = json.at("cell_y");
  header.geo = {json.at("crs_wkt"), json.at("west"), json.at("north"), grid.cell_x, grid.cell_y};
  header.rules.scale = {json.at("unit"),
                        json.at("square_unit"),
                        json.at("total"),
                        json.at("largest"),
                        json.at("trajectories"),
                        json.at("equal"),
                        0.0};
  header.rules.scale.largest_diameter = json.at("largest_diameter");
  header.rules.scale.room = json.at("room");
  if (!is_possible(header)) throw std::out_of_range("a number");
  return header;
}

void put_cell(HazardWriter& out, const HazardCell& cell) {
  out.put(static_cast<std::int32_t>(cell.first()));
  out.put(static_cast<std::uint32_t>(cell.bins().size()));
  for (const HazardCell::Bin& bin : cell.bins()) out.put(bin.weight), out.put(bin.square);
  out.put(static_cast<std::uint32_t>(cell.overlaps().size()));
  for (const std::int64_t overlap : cell.overlaps()) out.put(overlap);
  out.put(static_cast<std::uint32_t>(cell.lengths().size()));
  for (const WeightedLengths& sums : cell.lengths())
    for (const WideSum& sum : {sums.length, sums.by_diameter, sums.squares}) out.put(sum.low), out.put(sum.high);
}

WideSum get_sum(HazardReader& in) {
  const auto low = in.get<std::uint64_t>();
  return {low, in.get<std::uint64_t>()};
}

HazardCell get_cell(HazardReader& in, const HazardRules& rules) {
  const auto first = in.get<std::int32_t>();
  std::vector<HazardCell::Bin> bins(in.get_count(static_cast<std::size_t>(rules.bins.count())));
  if (first < 0 || first + static_cast<std::int64_t>(bins.size()) > rules.bins.count()) in.fail();
  for (HazardCell::Bin& bin : bins) bin = {in.get<std::int64_t>(), in.get<std::int64_t>()};
  std::vector<std::int64_t> overlaps(in.get_count(rules.levels()));
  for (std::int64_t& overlap : overlaps) overlap = in.get<std::int64_t>();
  std::vector<WeightedLengths> lengths(in.get_count(rules.levels()));
  for (WeightedLengths& sums : lengths) sums = {get_sum(in), get_sum(in), get_sum(in)};
  return HazardCell::restored(first, bins, overlaps, lengths);
}

/// Reads the mark and the format. Throws InputError for others.
/// @return whether energies count the rotation
bool get_format(HazardReader& in) {
  std::string mark(std::strlen(kMark), ' ');
  in.get(mark.data(), mark.size());
  if (mark != kMark) throw InputError(in.name() + ": is no file that talus run wrote; give the folder of a run");
  const auto format = in.get<std::int32_t>();
  if (format != kFormat && format != kRotationFormat)
    throw InputError(in.name() + ": was written by " + (format > kFormat ? "a later" : "an earlier") +
                     " version of Talus (format " + std::to_string(format) + ", this one reads " +
                     std::to_string(kFormat) + " and " + std::to_string(kRotationFormat) +
                     "); use that version, or run again");
  return format == kRotationFormat;
}

/// Reads the length of the header, and the header.
HazardHeader get_header(HazardReader& in) {
  std::string text(in.get_count(1U << 20U), ' ');
  in.get(text.data(), text.size());
  try {
    return header_of(text);
  } catch (const std::exception&) {
    in.fail();
  }
}

}  // namespace

void write_hazard(const std::filesystem::path& file, const LoadedScenario& loaded, const Tally& tally,
                  std::int64_t left_weight) {
  const Raster<float>& heights = loaded.scenario.surface.heights();
  const Grid& grid = heights.grid;
  HazardWriter out(file);
  out.put(kMark, std::strlen(kMark));
  out.put(std::int32_t{tally.hazard_rules().with_rotation ? kRotationFormat : kFormat});
  const std::string header = json_of(loaded, tally.hazard_rules(), left_weight).dump();
  out.put(static_cast<std::uint32_t>(header.size()));
  out.put(header.data(), header.size());
  for (int row = grid.rows - 1; row >= 0; --row) {
    tally.memory().keep_below_limit();
    for (int column = 0; column < grid.columns; ++column) {
      const CellRecord* record = tally.find(column, row);
      const unsigned state = (std::isnan(heights.at(column, row)) ? 0 : kTerrain) | (record != nullptr ? kTouched : 0) |
                             (record != nullptr && record->exits > 0 ? kExit : 0);
      out.put(static_cast<std::uint8_t>(state));
    }
    for (int column = 0; column < grid.columns; ++column)
      if (const HazardCell* cell = tally.hazard(column, row)) put_cell(out, *cell);
  }
  out.finish();
}

HazardHeader read_hazard(const std::filesystem::path& file, const std::function<void(const HazardHeader&)>& begin,
                         const std::function<void(const HazardRow&)>& visit) {
  HazardReader in(file);
  const bool with_rotation = get_format(in);
  HazardHeader header = get_header(in);
  header.rules.with_rotation = with_rotation;
  const double least =
      static_cast<double>(header.grid.columns) * header.grid.rows;  // bytes: each cell has one byte at least
  if (least > kMostPerByte * static_cast<double>(std::filesystem::file_size(file))) in.fail();
  begin(header);
  std::vector<std::uint8_t> states(static_cast<std::size_t>(header.grid.columns));
  for (int row = header.grid.rows - 1; row >= 0; --row) {
    in.get(states.data(), states.size());
    HazardRow cells;
    cells.row = row;
    for (const std::uint8_t state : states) cells.terrain.push_back((state & kTerrain) != 0);
    for (std::size_t column = 0; column < states.size(); ++column)
      if ((states[column] & kTouched) != 0)
        cells.touched.push_back({static_cast<int>(column), get_cell(in, header.rules), (states[column] & kExit) != 0});
    visit(cells);
  }
  in.finish();
  return header;
}

std::optional<std::filesystem::path> hazard_file_of(const std::filesystem::path& folder) {
  std::filesystem::path file = folder / kHazardFile;
  if (std::filesystem::exists(file)) return file;
  const std::vector<std::string> listed = files_of_record(folder / "run.json");
  if (std::ranges::count(listed, kHazardFile) == 0) return {};
  throw InputError(file.string() + ": is not there, though the run has annual frequencies: copy it again with the " +
                   "other results, or run the scenario again");
}

}  // namespace talus::io
