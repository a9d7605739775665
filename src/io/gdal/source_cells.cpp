#include "talus/io/gdal/source_cells.hpp"

#include <gdal_alg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "geopackage.hpp"
#include "layer.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus::io {
namespace {

/// Cells of a DEM: whether each is steep enough, and its slope.
class Cells {
 public:
  Cells(const Terrain& terrain, double slope) : terrain_(terrain), threshold_(std::tan(slope)) {}

  const Grid& grid() const { return terrain_.heights.grid; }
  double tangent(int column, int row) const { return horn_slope(terrain_.heights, column, row); }
  bool is_source(double tangent) const { return tangent >= threshold_; }
  double plan_area() const { return grid().cell_x * grid().cell_y; }

 private:
  const Terrain& terrain_;
  double threshold_;
};

/// Marks the sources with 1 in a raster in memory, in local metres; fills the sums in `found`.
Dataset mark(const Cells& cells, SourceCells& found) {
  const Grid& grid = cells.grid();
  Dataset marks = memory_dataset(grid.columns, grid.rows, GDT_Byte);
  std::array<double, 6> place{0.0, grid.cell_x, 0.0, grid.height(), 0.0, -grid.cell_y};
  marks->SetGeoTransform(place.data());
  std::vector<std::uint8_t> row(static_cast<std::size_t>(grid.columns));
  double steepest = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double tangent = cells.tangent(i, grid.rows - 1 - j);
      const bool source = cells.is_source(tangent);
      row[static_cast<std::size_t>(i)] = source ? 1 : 0;
      if (tangent > steepest) steepest = tangent;
      if (!source) continue;
      found.cells += 1;
      found.true_area += true_area(cells.grid(), tangent);
    }
    if (marks->GetRasterBand(1)->RasterIO(GF_Write, 0, j, grid.columns, 1, row.data(), grid.columns, 1, GDT_Byte, 0, 0,
                                          nullptr) != CE_None)
      throw std::runtime_error("the source cells cannot be marked");
  }
  found.plan_area = static_cast<double>(found.cells) * cells.plan_area();
  found.steepest = std::atan(steepest);
  return marks;
}

/// The outlines of connected cells, in memory.
Dataset outline(GDALDataset& marks, const std::function<bool()>& keep_going) {
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("Memory");
  Dataset outlines(driver == nullptr ? nullptr : driver->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  OGRLayer* layer = outlines == nullptr ? nullptr : outlines->CreateLayer("outlines", nullptr, wkbPolygon, nullptr);
  if (layer == nullptr) throw std::runtime_error("no memory for the outlines: " + messages.take());
  const auto ask = [](double, const char*, void* argument) {
    return (*static_cast<const std::function<bool()>*>(argument))() ? TRUE : FALSE;
  };
  GDALRasterBand* band = marks.GetRasterBand(1);
  if (GDALPolygonize(band, band, OGRLayer::ToHandle(layer), -1, nullptr, ask,
                     const_cast<std::function<bool()>*>(&keep_going)) != CE_None &&
      keep_going())
    throw std::runtime_error("the source cells cannot be outlined: " + messages.take());
  return outlines;
}

void shift(OGRPolygon& polygon, double east, double north) {
  for (OGRLinearRing* ring : polygon)
    for (int i = 0; i < ring->getNumPoints(); ++i) ring->setPoint(i, ring->getX(i) + east, ring->getY(i) + north);
}

/// Attributes of a polygon, from its cells.
void describe(OGRFeature& row, const Cells& cells, const OGRPolygon& local) {
  double sum = 0.0, steepest = 0.0, area = 0.0;
  GIntBig count = 0;
  for_each_cell(local, cells.grid(), CellRule::Covered, [&](int column, int cell_row) {
    const double tangent = cells.tangent(column, cell_row);
    sum += std::atan(tangent);
    steepest = std::max(steepest, tangent);
    area += true_area(cells.grid(), tangent);
    ++count;
  });
  row.SetField(0, degrees(sum / static_cast<double>(count)));
  row.SetField(1, degrees(std::atan(steepest)));
  row.SetField(2, area);
  row.SetField(3, static_cast<double>(count) * cells.plan_area());
  row.SetField(4, count);
}

void write_polygons(GeoPackage& file, const Cells& cells, OGRLayer& outlines, SourceCells& found,
                    const std::function<bool()>& keep_going) {
  OGRLayer* layer = file.add_layer(kSourceLayers.front().c_str(), wkbPolygon,
                                   {{"slope_deg", OFTReal},
                                    {"slope_max_deg", OFTReal},
                                    {"area_m2", OFTReal},
                                    {"plan_area_m2", OFTReal},
                                    {"cells", OFTInteger64}});
  const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  outlines.ResetReading();
  while (const Feature outline{outlines.GetNextFeature()}) {
    if (!keep_going()) return;
    OGRPolygon polygon = *outline->GetGeometryRef()->toPolygon();
    describe(*row, cells, polygon);
    shift(polygon, cells.grid().west, cells.grid().south);
    row->SetGeometry(&polygon);
    file.append(layer, *row);
    ++found.polygons;
  }
}

void write_points(GeoPackage& file, const Cells& cells, const std::function<bool()>& keep_going) {
  const Grid& grid = cells.grid();
  OGRLayer* layer =
      file.add_bulk_layer(kSourceLayers.back().c_str(), wkbPoint, {{"slope_deg", OFTReal}, {"area_m2", OFTReal}});
  const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  for (int j = grid.rows - 1; j >= 0 && keep_going(); --j)
    for (int i = 0; i < grid.columns; ++i) {
      const double tangent = cells.tangent(i, j);
      if (!cells.is_source(tangent)) continue;
      row->SetField(0, degrees(std::atan(tangent)));
      row->SetField(1, true_area(cells.grid(), tangent));
      const OGRPoint point(grid.west + grid.centre_x(i), grid.south + grid.centre_y(j));
      row->SetGeometry(&point);
      file.append(layer, *row);
    }
}

}  // namespace

SourceCells write_source_cells(const std::filesystem::path& file, const Terrain& terrain, double slope,
                               const SourceStyles& styles, const std::function<bool()>& keep_going) {
  start_gdal();
  const Cells cells(terrain, slope);
  SourceCells found;
  const Dataset marks = mark(cells, found);
  if (found.cells == 0 || !keep_going()) return found;
  const Dataset outlines = outline(*marks, keep_going);
  GeoPackage package(file, terrain.geo);
  write_polygons(package, cells, *outlines->GetLayer(0), found, keep_going);
  write_points(package, cells, keep_going);
  package.set_style(kSourceLayers[0], styles.polygons);
  package.set_style(kSourceLayers[1], styles.points);
  package.finish();
  return found;
}

}  // namespace talus::io
