#include "deposit_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "campaign_checks.hpp"
#include "campaign_tables.hpp"
#include "io/gdal/csv_table.hpp"
#include "io/gdal/idle_features.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus::io {
namespace {

constexpr Bounds kDiameter{"diameter_m", "m", "of the sphere of the block's volume", 0.0, 50.0, Bounds::AboveMin};
constexpr Bounds kDropHeight{"release_height", "m", "of the release above the terrain", 0.0, 500.0};
constexpr double kManyOutside = 0.2, kMostOutside = 0.5;  // share of the blocks that lie outside the mapped polygons
constexpr Bounds kStrips{"strips", "1", "number of strips across the slope", 2.0, 50.0, Bounds::Closed, true};
constexpr Bounds kStrip{"holdout", "1", "number of a strip", 1.0, 50.0, Bounds::Closed, true};
constexpr Bounds kClass{"classes", "m", "diameter between two classes", 0.0, 100.0, Bounds::AboveMin};

void check_strips(TableReader& table, const DepositSpec& spec) {
  const auto fault = [&](const char* key, const std::string& rule) {
    table.fault(key, *table.value()->find(key), rule);
  };
  if (spec.strips == 0 && !spec.held_out.empty()) fault("holdout", "must come with strips, their number: strips = 5");
  if (spec.strips > 0 && spec.held_out.empty())
    fault("strips", "must come with holdout, the numbers of those held out: holdout = [2, 4]");
  for (const double number : spec.held_out)
    if (spec.strips > 0 && number > static_cast<double>(spec.strips))
      fault("holdout", "must be at most strips = " + std::to_string(spec.strips));
  if (spec.strips > 0 && spec.held_out.size() >= spec.strips) fault("holdout", "must leave a strip to fit to");
}

/// The mapped blocks, in the order of their ids.
class DepositTable {
 public:
  DepositTable(const std::string& path, const Terrain& terrain, std::vector<std::string>& warnings)
      : path_(path),
        terrain_(terrain),
        table_(table_of_campaign(
            path, {"id", "x", "y", "mass_kg", "diameter_m", "density_kgm3", "L1_m", "L2_m", "L3_m", "group", "holdout"},
            {"id", "x", "y"}, warnings)),
        warnings_(warnings) {
    if (!table_.has("mass_kg") && !table_.has("diameter_m"))
      throw InputError(path + ":1: has no column mass_kg or diameter_m, must have one of them: the size of a block " +
                       "decides how far it goes");
  }

  std::vector<MeasuredBlock> read(const Surface& surface) {
    std::vector<MeasuredBlock> blocks;
    table_.for_each_row([&](const CsvTable::Row& row) {
      MeasuredBlock block;
      block.id = table_.name(row, "id");
      refuse_second(table_, row, lines_);
      block.stream = stream_of_name(block.id);
      block.stop = place_of(row, surface);
      block.density = table_.number(row, "density_kgm3", kDensity).value_or(2700.0);
      block.mass = mass_of(row, block.density);
      block.axes = axes_of(table_, row, equivalent_diameter(block.mass, block.density));
      block.group = table_.text(row, "group");
      block.holdout = table_.number(row, "holdout", kHoldout).value_or(0.0) == 1.0;
      blocks.push_back(std::move(block));
    });
    std::ranges::sort(blocks, {}, &MeasuredBlock::id);
    warn_of_diameters(path_, std::move(ratios_), warnings_);
    return blocks;
  }

 private:
  Eigen::Vector2d place_of(const CsvTable::Row& row, const Surface& surface) const {
    const Grid& grid = terrain_.heights.grid;
    const Eigen::Vector2d place(table_.required(row, "x", kPlace) - grid.west,
                                table_.required(row, "y", kPlace) - grid.south);
    if (!surface.height(place.x(), place.y()))
      table_.refuse(row, "x",
                    "with y = " + table_.text(row, "y") +
                        " the block lies off the terrain, must lie on it: are the coordinates those of the DEM's "
                        "system?");
    return place;
  }

  double mass_of(const CsvTable::Row& row, double density) {
    const auto mass = table_.number(row, "mass_kg", kMass);
    const auto diameter = table_.number(row, "diameter_m", kDiameter);
    if (!mass && !diameter)
      table_.refuse(row, table_.has("mass_kg") ? "mass_kg" : "diameter_m",
                    "must be given, as mass_kg or diameter_m: the size of a mapped block decides how far it goes; "
                    "estimate it, or leave the row out");
    const double sphere = diameter ? density * kPi / 6.0 * *diameter * *diameter * *diameter : 0.0;
    if (!mass) return sphere;
    if (!diameter) return *mass;
    if (*mass > kMassFactor * sphere || sphere > kMassFactor * *mass)
      table_.refuse(row, "diameter_m",
                    "is that of a sphere of " + with_digits(sphere, 4) +
                        " kg, must not be more than 3 times above or below mass_kg = " + text_of(*mass) +
                        ": correct one of them, or leave the other empty");
    ratios_.push_back(*mass / sphere);
    return *mass;
  }

  std::string path_;
  const Terrain& terrain_;
  CsvTable table_;
  std::vector<std::string>& warnings_;
  std::vector<double> ratios_;  // of masses to those of spheres of the diameters beside them
  std::unordered_map<std::string, int> lines_;
};

void warn_of_release_heights(const std::string& path, const SourceLayer& layer, const Terrain& terrain,
                             std::vector<std::string>& warnings) {
  double highest = 0.0;  // above the ground [m]
  for (const SourceFeature& feature : layer.features) highest = std::max(highest, feature.release_height.high);
  const double most = doubted_height(terrain.heights);
  if (highest > most)
    warnings.push_back(path + ": blocks are released up to " + with_digits(highest, 3) +
                       " m above the ground, more than " + with_digits(most, 3) +
                       " m: is release_height in m, and not the height of the cliff?");
}

/// The sources of a file, each cell once.
std::vector<DepositSource> sources_of(const DepositSpec& spec, const Terrain& terrain,
                                      std::vector<std::string>& warnings) {
  const SourceLayer layer = read_sources(spec.sources.path, terrain, spec.release_height);
  warnings.insert(warnings.end(), layer.warnings.begin(), layer.warnings.end());
  if (layer.unread_height)  // there is no --field here
    warnings.push_back(spec.sources.path +
                       ": a field height is not read (it is mostly the height of a cliff): if it is the height of "
                       "release above the ground, call it release_height");
  for (const Setting& setting : layer.attributes)
    if (setting.key.ends_with(".frequency") || setting.key.find(".diameter") != std::string::npos)
      warnings.push_back(spec.sources.path + ": the field " + setting.key.substr(setting.key.rfind('.') + 1) +
                         " counts nothing here: a source is as likely as its area, a block as large as it was mapped");
  warn_of_release_heights(spec.sources.path, layer, terrain, warnings);
  const Grid& grid = terrain.heights.grid;
  const double plan = grid.cell_x * grid.cell_y;
  std::vector<bool> taken(grid.cells(), false);  // by a polygon: a point in the cell is a source of its own
  std::vector<DepositSource> sources;
  for (const SourceCell& cell : layer.cells) {
    const int column = grid.column_of(cell.x), row = grid.row_of(cell.y);
    const std::size_t at = grid.index(column, row);
    if (!cell.point && taken[at]) continue;
    if (!cell.point) taken[at] = true;
    const SourceFeature& feature = layer.features[cell.feature];
    sources.push_back({{cell.x, cell.y, terrain.heights.at(column, row)},
                       cell.point ? plan : true_area(terrain.heights, column, row),
                       cell.point,
                       feature.release_height,
                       feature.velocity});
  }
  return sources;
}

/// 1 in the cells whose centres the polygons cover.
Raster<std::uint8_t> mapped_cells(const NamedFile& mapped, const Terrain& terrain, std::vector<std::string>& warnings) {
  const Grid& grid = terrain.heights.grid;
  if (mapped.path.empty()) return {grid, std::uint8_t{1}};
  Raster<std::uint8_t> cells(grid, std::uint8_t{0});
  Layer layer("mapped", mapped.path, terrain);
  std::size_t polygons = 0, marked = 0;
  for_each_feature(layer, [&](const Feature& feature) {
    const Parts parts = layer.polygons(*feature, ": blocks were mapped inside");
    polygons += parts.polygons.size();
    marked += mark_cells(parts, 1, terrain, cells).all;
  });
  for (std::string& line : layer.warnings()) warnings.push_back(std::move(line));
  if (marked == 0)
    throw InputError(mapped.where + ": " +
                     (polygons == 0 ? "has no polygons, must have those inside which blocks were mapped"
                                    : "its polygons cover no cell of the DEM, must be those inside which blocks were "
                                      "mapped: is the coordinate system the right one?"));
  return cells;
}

/// Leaves out the blocks that lie outside the polygons.
void keep_mapped(const DepositSpec& spec, const MappedDeposits& deposits, std::vector<MeasuredBlock>& blocks,
                 std::vector<std::string>& warnings) {
  std::vector<std::string> outside;
  const auto unmapped = [&](const MeasuredBlock& block) { return region_at(deposits, *block.stop) == 0; };
  for (const MeasuredBlock& block : blocks)
    if (unmapped(block)) outside.push_back(block.id);
  const std::size_t all = blocks.size();
  std::erase_if(blocks, unmapped);
  if (blocks.empty())
    throw InputError(spec.mapped.where + ": none of the " + std::to_string(all) + " blocks of " + spec.table.path +
                     " lies inside its polygons, five must: are they those inside which blocks were mapped?");
  if (outside.empty()) return;
  const double share = static_cast<double>(outside.size()) / static_cast<double>(all);
  const std::string said = spec.table.path + ": " + std::to_string(outside.size()) + " of " + std::to_string(all) +
                           " blocks lie outside the mapped polygons";
  const std::string way_out =
      "draw the polygons round all ground where every block was mapped, in the right coordinate "
      "system, or delete the rows of blocks from elsewhere";
  if (share > kMostOutside) throw InputError(said + ", more than half: " + listed(outside) + "; " + way_out);
  warnings.push_back(
      said + " and are left out: " + listed(outside) +
      (share < kManyOutside ? "" : "; these are so many that the rest may be no picture of the map: " + way_out));
}

/// Says which blocks no source can have released.
void warn_of_higher_blocks(const DepositSpec& spec, const MappedDeposits& deposits, const Terrain& terrain,
                           const std::vector<MeasuredBlock>& blocks, std::vector<std::string>& warnings) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const DepositSource& source : deposits.sources) {
    const double up = std::max(0.0, source.velocity.z());
    highest = std::max(highest, source.place.z() + source.release_height.high + up * up / (2.0 * kGravity));
  }
  const Grid& grid = terrain.heights.grid;
  std::vector<std::string> higher;
  for (const MeasuredBlock& block : blocks)
    if (terrain.heights.at(grid.column_of(block.stop->x()), grid.row_of(block.stop->y())) > highest)
      higher.push_back(block.id);
  if (higher.empty()) return;
  warnings.push_back(spec.table.path + ": " + std::to_string(higher.size()) + " of " + std::to_string(blocks.size()) +
                     " blocks lie higher than any release from " + spec.sources.path + ", at " +
                     with_digits(highest, 4) + " m at most: " + listed(higher) +
                     "; no block can get there: is a cliff missing, or are the coordinates wrong?");
}

void require_blocks_for(const DepositSpec& spec, std::size_t blocks) {
  if (spec.strips > blocks)
    throw InputError("[deposits] strips = " + std::to_string(spec.strips) + ", must be at most " +
                     std::to_string(blocks) + ", the number of mapped blocks in " + spec.table.path);
}

/// Makes two regions of the mapped one: the strips that are fitted to, and those that are held out.
void hold_out_strips(const DepositSpec& spec, MappedDeposits& deposits, std::vector<MeasuredBlock>& blocks) {
  std::vector<Eigen::Vector2d> places;
  for (const MeasuredBlock& block : blocks) places.push_back(*block.stop);
  const Strips strips = strips_of(deposits, places, spec.strips);
  Raster<std::uint8_t>& region = deposits.region;
  for (int row = 0; row < region.grid.rows; ++row)
    for (int column = 0; column < region.grid.columns; ++column) {
      const auto strip =
          1.0 + static_cast<double>(strips.of({region.grid.centre_x(column), region.grid.centre_y(row)}));
      if (region.at(column, row) != 0 && std::ranges::count(spec.held_out, strip) > 0) region.at(column, row) = 2;
    }
  for (MeasuredBlock& block : blocks) block.holdout = region_at(deposits, *block.stop) == 2;
}

}  // namespace

NamedFile file_there(TableReader& table, const std::string& key, const std::filesystem::path& base) {
  const NamedFile file = table.named_file(key, base).value_or(NamedFile());
  check_files({&file}, table.faults());
  return file;
}

DepositSpec read_deposit_spec(TableReader table, const std::filesystem::path& base) {
  DepositSpec spec;
  if (table.value() == nullptr) return spec;
  spec.given = true;
  spec.table = file_there(table, "file", base);
  spec.sources = file_there(table, "sources", base);
  spec.mapped = file_there(table, "mapped", base);
  spec.release_height = table.range("release_height", kDropHeight).value_or(Range{1.0, 1.0});
  spec.strips = static_cast<std::size_t>(table.number("strips", kStrips).value_or(0.0));
  spec.held_out = table.numbers("holdout", kStrip).value_or(std::vector<double>());
  spec.classes = table.numbers("classes", kClass).value_or(std::vector<double>());
  check_strips(table, spec);
  if (!std::ranges::is_sorted(spec.classes, std::ranges::less_equal()))
    table.fault("classes", *table.value()->find("classes"), "must ascend");
  table.finish();
  if (table.value()->find("sources") == nullptr)
    table.faults().push_back(table.file() +
                             ": [deposits] has no sources, must name the polygons from which the blocks " +
                             "may have come: sources = \"cliffs.gpkg\" (talus sources makes candidates)");
  if (spec.table.path.empty() && table.value()->find("file") == nullptr) {
    spec.table = {absolute_path("deposits.csv", base), table.file() + ": [deposits]"};
    std::error_code none;
    if (!std::filesystem::exists(spec.table.path, none))
      table.faults().push_back(table.file() +
                               ": [deposits] has no file, and there is no deposits.csv beside it, must " +
                               "name the table of the mapped blocks: file = \"deposits.csv\"");
  }
  return spec;
}

void read_deposits(const DepositSpec& spec, const Terrain& terrain, Campaign& campaign,
                   std::vector<std::string>& warnings) {
  campaign.blocks = DepositTable(spec.table.path, terrain, warnings).read(campaign.surface);
  if (campaign.blocks.empty())
    throw InputError(spec.table.path + ": has no blocks, must have one row for each that was mapped");
  warn_of_masses(spec.table.path, campaign.blocks, warnings);
  warn_of_median(spec.table.path, campaign.blocks, warnings);
  if (spec.strips > 0 && std::ranges::any_of(campaign.blocks, &MeasuredBlock::holdout))
    throw InputError(spec.table.path + ": has a column holdout beside [deposits] strips, must be one of them");
  if (spec.mapped.path.empty())
    warnings.push_back(
        "[deposits] names no mapped polygons: the whole DEM counts as mapped, so that a simulated stop "
        "where nobody looked counts against the model");
  MappedDeposits deposits =
      mapped_deposits(sources_of(spec, terrain, warnings), mapped_cells(spec.mapped, terrain, warnings));
  keep_mapped(spec, deposits, campaign.blocks, warnings);
  warn_of_higher_blocks(spec, deposits, terrain, campaign.blocks, warnings);
  if (spec.strips > 0) {
    require_blocks_for(spec, campaign.blocks.size());
    hold_out_strips(spec, deposits, campaign.blocks);
    deposits = mapped_deposits(std::move(deposits.sources), std::move(deposits.region));
  }
  std::vector<double> diameters;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) diameters.push_back(equivalent_diameter(block.mass, block.density));
  deposits.limits = spec.classes.empty() ? class_limits(std::move(diameters)) : spec.classes;
  for (MeasuredBlock& block : campaign.blocks) {  // for messages and pictures: no release is known
    const Grid& grid = terrain.heights.grid;
    const std::uint32_t nearest = deposits.nearest.at(grid.column_of(block.stop->x()), grid.row_of(block.stop->y()));
    block.x = deposits.sources[nearest].place.x();
    block.y = deposits.sources[nearest].place.y();
  }
  campaign.deposits = std::make_shared<const MappedDeposits>(std::move(deposits));
}

}  // namespace talus::io
