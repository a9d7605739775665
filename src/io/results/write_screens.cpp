#include "talus/io/results/write_screens.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/files/json.hpp"
#include "io/gdal/layer_file.hpp"
#include "talus/base/expect.hpp"
#include "talus/io/results/vector_style.hpp"

namespace talus::io {
namespace {

/// The quantities of the layer, with the beginnings of the names of their fields.
constexpr std::array<std::pair<std::string_view, const char*>, 3> kQuantities{
    {{"speed", "speed_ms"}, {"energy", "energy_kj"}, {"jump height", "jump_height_m"}}};

std::size_t index_of(std::string_view quantity) {
  const auto all = screen_quantities();
  const auto found = std::ranges::find(all, quantity, &ScreenQuantity::name);
  TALUS_EXPECT(found != all.end(), "a quantity of the layer is one of the summary");
  return static_cast<std::size_t>(found - all.begin());
}

/// The lines of a screen in map coordinates.
std::unique_ptr<OGRMultiLineString> lines_of(const Screen& screen, double west, double south) {
  auto all = std::make_unique<OGRMultiLineString>();
  for (const auto& places : screen.lines) {
    OGRLineString line;
    for (const Eigen::Vector2d& place : places) line.addPoint(west + place.x(), south + place.y());
    all->addGeometry(&line);
  }
  return all;
}

}  // namespace

void write_screens(const std::filesystem::path& file, const LoadedScenario& loaded, const ScreenSummary& summary) {
  std::vector<std::string> names;
  for (const auto& [quantity, name] : kQuantities)
    for (const char* figure : {"_p50", "_p95", "_max"}) names.push_back(std::string(name) + figure);
  std::vector<LayerFile::Column> columns{{"id", OFTString}, {"crossings", OFTInteger64}, {"blocks", OFTInteger64}};
  for (const std::string& name : names) columns.push_back({name.c_str(), OFTReal});
  const std::unique_ptr<LayerFile> layers = new_layer_file(file, loaded.geo);
  OGRLayer* layer = layers->add_bulk_layer("screens", wkbMultiLineString, columns);
  const Grid& grid = loaded.scenario.surface.grid();
  const double south = loaded.geo.north - grid.rows * loaded.geo.cell_y;
  for (std::size_t s = 0; s < loaded.scenario.screens.size(); ++s) {
    const GdalMessages messages;
    const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    const ScreenSummary::Row first = summary.row(s, 0);
    row->SetField(0, loaded.scenario.screens[s].id.c_str());
    row->SetField(1, static_cast<GIntBig>(first.crossings));
    row->SetField(2, static_cast<GIntBig>(first.blocks));
    int next = 3;
    for (const auto& [quantity, name] : kQuantities) {
      const ScreenSummary::Row figures = summary.row(s, index_of(quantity));
      for (const double value : {figures.p50, figures.p95, figures.maximum}) {
        if (std::isfinite(value)) row->SetField(next, six_digits(value));
        ++next;
      }
    }
    row->SetGeometryDirectly(lines_of(loaded.scenario.screens[s], loaded.geo.west, south).release());
    layers->append(layer, *row);
  }
  layers->set_style("screens", style_of(StyledLayer::Screens));
  layers->finish();
}

}  // namespace talus::io
