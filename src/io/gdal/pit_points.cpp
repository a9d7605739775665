#include "talus/io/gdal/pit_points.hpp"

#include "geopackage.hpp"
#include "talus/terrain/pits.hpp"

namespace talus::io {

void write_pits(const std::filesystem::path& file, const Raster<float>& heights, const GeoReference& geo,
                const std::string& style) {
  start_gdal();
  const Grid& grid = heights.grid;
  const MapPlace place(geo, grid);
  GeoPackage package(file, geo);
  OGRLayer* layer = package.add_bulk_layer(kPitLayers.front().c_str(), wkbPoint,
                                           {{"kind", OFTString}, {"depth_m", OFTReal}, {"z", OFTReal}});
  const Feature feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column) {
      const double pit = pit_depth(heights, column, row), dam = dam_height(heights, column, row);
      if (!(pit > 0.0 || dam > 0.0)) continue;
      feature->SetField(0, pit > 0.0 ? "pit" : "dammed");
      feature->SetField(1, pit > 0.0 ? pit : dam);
      feature->SetField(2, double{heights.at(column, row)});
      const OGRPoint point(place.x(grid.centre_x(column)), place.y(grid.centre_y(row)));
      feature->SetGeometry(&point);
      package.append(layer, *feature);
    }
  package.set_style(kPitLayers.front(), style);
  package.finish();
}

}  // namespace talus::io
