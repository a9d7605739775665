#include "talus/io/results/write_screens.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "io/files/json.hpp"
#include "io/gdal/layer_file.hpp"
#include "screen_columns.hpp"
#include "talus/base/expect.hpp"
#include "talus/io/results/vector_style.hpp"

namespace talus::io {
namespace {

std::size_t index_of(std::string_view quantity) {
  const auto all = screen_quantities();
  const auto found = std::ranges::find(all, quantity, &ScreenQuantity::name);
  TALUS_EXPECT(found != all.end(), "a quantity of the layer is one of the summary");
  return static_cast<std::size_t>(found - all.begin());
}

/// The lines of a screen in map coordinates.
std::unique_ptr<OGRMultiLineString> lines_of(const Screen& screen, const MapPlace& place) {
  auto all = std::make_unique<OGRMultiLineString>();
  for (const auto& points : screen.lines) {
    OGRLineString line;
    for (const Eigen::Vector2d& point : points) line.addPoint(place.x(point.x()), place.y(point.y()));
    all->addGeometry(&line);
  }
  return all;
}

}  // namespace

void write_screens(const std::filesystem::path& file, const LoadedScenario& loaded, const ScreenSummary& summary) {
  std::vector<std::string> names;
  for (const ScreenColumn& column : kScreenColumns)
    for (const char* figure : {"_p50", "_p95", "_max"}) names.push_back(std::string(column.column) + figure);
  std::vector<LayerFile::Column> columns{{"id", OFTString}, {"crossings", OFTInteger64}, {"blocks", OFTInteger64}};
  for (const std::string& name : names) columns.push_back({name.c_str(), OFTReal});
  const std::unique_ptr<LayerFile> layers = new_layer_file(file, loaded.geo);
  OGRLayer* layer = layers->add_bulk_layer("screens", wkbMultiLineString, columns);
  const MapPlace place(loaded.geo, loaded.scenario.surface.grid());
  for (std::size_t s = 0; s < loaded.scenario.screens.size(); ++s) {
    const GdalMessages messages;
    const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    const ScreenSummary::Row first = summary.row(s, 0);
    row->SetField(0, loaded.scenario.screens[s].id.c_str());
    row->SetField(1, static_cast<GIntBig>(first.crossings));
    row->SetField(2, static_cast<GIntBig>(first.blocks));
    int next = 3;
    for (const ScreenColumn& column : kScreenColumns) {
      const ScreenSummary::Row figures = summary.row(s, index_of(column.quantity));
      for (const double value : {figures.p50, figures.p95, figures.maximum}) {
        if (std::isfinite(value)) row->SetField(next, six_digits(value));
        ++next;
      }
    }
    row->SetGeometryDirectly(lines_of(loaded.scenario.screens[s], place).release());
    layers->append(layer, *row);
  }
  layers->set_style("screens", style_of(StyledLayer::Screens));
  layers->finish();
}

}  // namespace talus::io
