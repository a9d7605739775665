#include "talus/io/gdal/rasters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dataset.hpp"
#include "dem_warning.hpp"
#include "heights.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

namespace {

std::string numbers_text(const std::array<double, 6>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + text_of(number);
  return text;
}

/// Throws InputError if the geotransform holds no place on the earth.
void check_place(const std::string& path, const std::array<double, 6>& g) {
  const std::string found = path + ": its place (geotransform " + numbers_text(g) + ") ";
  const std::string way_out = ": georeference it with " + edit_command(path, "-a_ullr WEST NORTH EAST SOUTH");
  if (!std::ranges::all_of(g, [](double number) { return std::isfinite(number); }))
    throw InputError(found + "has a number that is not finite, must be six numbers" + way_out);
  if ((g[1] == 0.0 && g[2] == 0.0) || (g[4] == 0.0 && g[5] == 0.0))
    throw InputError(found + "has cells of 0 m, must be " + text_of(bounds_of("dem.cell").min) + " to " +
                     text_of(bounds_of("dem.cell").max) + " m" + way_out);
  if (!is_place(g[0], g[3]))
    throw InputError(found + "is none on the earth, must be within " + text_of(kFarthestPlace) + " m of the origin" +
                     way_out);
}

GeoReference read_place(GDALDataset& dataset, const std::string& path) {
  std::array<double, 6> g{};
  if (dataset.GetGeoTransform(g.data()) != CE_None)
    throw InputError(path +
                     ": does not say where it lies (no geotransform), must be a north-up raster: georeference it with "
                     "" +
                     edit_command(path, "-a_ullr WEST NORTH EAST SOUTH"));
  check_place(path, g);
  if (std::abs(g[2]) > 1e-9 * std::abs(g[1]) || std::abs(g[4]) > 1e-9 * std::abs(g[5]) || g[1] == 0.0) {
    const double turn = degrees(std::atan2(g[4], g[1]));
    throw InputError(path + ": raster is rotated or sheared (by " + text_of(std::round(turn * 100.0) / 100.0) +
                     " deg), must be north-up: resample it, for example with gdalwarp -r cubicspline " +
                     shell_word(path) + " north_up.tif");
  }
  if (g[1] < 0.0 || g[5] > 0.0)
    throw InputError(
        path +
        ": rows run from south to north or columns from east to west, must be north-up: turn it over with gdalwarp " +
        shell_word(path) + " north_up.tif");
  GeoReference geo;
  geo.crs_wkt = wkt_of(dataset.GetSpatialRef());
  geo.west = g[0];
  geo.north = g[3];
  geo.cell_x = g[1];
  geo.cell_y = -g[5];
  return geo;
}

void check_cell(const std::string& path, double size) {
  if (const auto fault = fault_of(bounds_of("dem.cell"), size))
    throw InputError(path + ": cells of " + text_of(size) + " m, " + *fault +
                     ": resample it with gdalwarp -r cubicspline -tr");
}

/// Units of length that are no metres.
struct OtherUnit {
  std::string_view symbol, names;
  double metres;
};
constexpr OtherUnit kOtherUnits[] = {{"mm", "millimetres", 0.001}, {"cm", "centimetres", 0.01},
                                     {"dm", "decimetres", 0.1},    {"km", "kilometres", 1000.0},
                                     {"in", "inches", 0.0254},     {"yd", "yards", 0.9144}};

/// Throws InputError if the band holds no heights: numbers of colours, or all equal by a scale of 0.
void check_values(GDALRasterBand& band, const std::string& path, std::vector<std::string>& warnings) {
  if (band.GetColorInterpretation() == GCI_PaletteIndex || band.GetColorTable() != nullptr)
    throw InputError(path +
                     ": band 1 is a picture (its numbers stand for the colours of a palette), must be heights in "
                     "metres: give the raster of heights from which the picture was made");
  int given = 0;
  const double scale = band.GetScale(&given), offset = band.GetOffset();
  if (!std::isfinite(scale) || !std::isfinite(offset) || scale == 0.0)
    throw InputError(
        path + ": band 1 has the scale " + text_of(scale) + " and the offset " + text_of(offset) +
        ", must be numbers and the scale not 0, which makes all heights equal: mend them, for example with "
        "gdal_translate -a_scale 1 -a_offset 0 " +
        shell_word(path) + " mended.tif");
  if (scale != 1.0 || offset != 0.0)
    warnings.push_back(path + ": heights are the numbers of band 1 times its scale " + text_of(scale) +
                       " plus its offset " + text_of(offset) + ", as the file says");
}

void check_band(GDALRasterBand& band, const std::string& path, std::vector<std::string>& warnings) {
  if (GDALDataTypeIsComplex(band.GetRasterDataType()) != 0)
    throw InputError(path + ": band 1 has complex numbers, must be heights in metres");
  if (band.GetRasterDataType() == GDT_Byte)
    warnings.push_back(path +
                       ": band 1 holds bytes (0 to 255), as pictures do and hillshades: are these heights in "
                       "metres? Take the DEM that it was made of");
  const std::string unit = lowercase(band.GetUnitType());
  check_values(band, path, warnings);
  if (unit.empty() || unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters") return;
  const bool feet = unit.find("ft") != std::string::npos || unit.find("foot") != std::string::npos ||
                    unit.find("feet") != std::string::npos;
  const auto known = std::ranges::find_if(kOtherUnits, [&](const OtherUnit& other) {
    return unit == other.symbol || unit.starts_with(other.names.substr(0, 4));
  });
  if (feet || known != std::end(kOtherUnits))
    throw InputError(
        path + ": heights are in " + (feet ? "feet" : std::string(known->names)) + " (unit '" + band.GetUnitType() +
        "' of band 1), must be metres: convert them with gdal_calc.py -A " + shell_word(path) + " --calc='A*" +
        text_of(feet ? 0.3048 : known->metres) +
        "' --type=Float32 --outfile=metres.tif, or if they are metres, say so with gdal_edit.py -units m " +
        shell_word(path));
  warnings.push_back(path + ": unknown unit '" + band.GetUnitType() + "' of the heights: taken as metres");
}

}  // namespace

MapExtent Terrain::extent() const {
  const Grid& g = heights.grid;
  return {g.west, g.south, g.west + g.width(), g.south + g.height()};
}

Terrain read_terrain(const std::string& path, const RasterMemory& memory, int threads) {
  const Dataset dataset = open_dataset(path, GDAL_OF_RASTER);
  GdalMessages messages;
  if (dataset->GetRasterCount() < 1)
    throw InputError(path +
                     ": has no band, must be one raster (one of several in a file is named like NETCDF:file.nc:height, "
                     "see gdalinfo)");
  Terrain terrain;
  terrain.geo = read_place(*dataset, path);
  Grid grid{dataset->GetRasterXSize(), dataset->GetRasterYSize(), terrain.geo.cell_x,
            terrain.geo.cell_y,        terrain.geo.west,          0.0};
  grid.south = terrain.geo.north - grid.height();
  if (grid.columns < 2 || grid.rows < 2)
    throw InputError(path + ": has " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                     " cells, must have at least 2 x 2");
  const MapExtent extent{grid.west, grid.south, grid.west + grid.width(), terrain.geo.north};
  if (const auto warning = check_metric(path, terrain.geo.crs_wkt, extent)) terrain.warnings.push_back(*warning);
  terrain.geo.crs_wkt = without_heights(terrain.geo.crs_wkt);
  check_cell(path, grid.cell_x);
  check_cell(path, grid.cell_y);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  check_band(band, path, terrain.warnings);
  bool alpha = false;
  for (int i = 2; i <= dataset->GetRasterCount(); ++i)
    alpha = alpha || dataset->GetRasterBand(i)->GetColorInterpretation() == GCI_AlphaBand;
  if (alpha && band.GetMaskFlags() == GMF_ALL_VALID)
    throw InputError(path +
                     ": has a band of transparency (alpha), which says nothing beside heights of this type, must " +
                     "say where there are none by a nodata value: gdalwarp -dstnodata -9999 in place of -dstalpha");
  if (dataset->GetRasterCount() > (alpha ? 2 : 1))
    terrain.warnings.push_back(path + ": has " + std::to_string(dataset->GetRasterCount()) +
                               " bands: the first is taken as heights");
  terrain.heights.grid = grid;
  fill_raster(terrain.heights, memory, [&] { read_heights(path, terrain, threads); });
  for (std::string& line : dem_warnings(path, dem_figures(terrain.heights), std::min(grid.cell_x, grid.cell_y)))
    terrain.warnings.push_back(std::move(line));
  return terrain;
}

}  // namespace talus::io
