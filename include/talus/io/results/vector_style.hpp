#pragma once
#include <filesystem>
#include <string>

namespace talus::io {

/// The layers of results that have a style.
enum class StyledLayer {
  Stops,
  Exits,
  Trajectories,
  Screens,
  AreaObjects,
  LineObjects,
  Stretches,
  Crossings,  // of a profile, at their places
  Bins,       // pieces of a profile
  Pits,
  SourceAreas,  // candidates of `talus sources`
  SourcePoints
};

/// The look of a layer in QGIS (3.22 and later): the text that its GeoPackage holds as the default style of the layer.
///
/// Features in the classes of a legend that a raster has too: `stops` and `exits` by energy, `trajectories` by speed,
/// `screens` by the P95 of the energy, objects by return period, stretches of a barrier by MEL; pits by depth and
/// candidates of sources by slope, for which there is no raster. docs/products.md, "Styles".
std::string style_of(StyledLayer layer);

/// The look of an input in QGIS: an outline over the results. @param dimension  0 points, 1 lines, 2 areas
std::string outline_style(int dimension);

/// Writes X.qml beside each layer X.fgb of a run, in which there is no room for a style. Where a raster has a style of
/// this name (exits.qml), the file gets both: QGIS takes from it what fits the kind of a layer. Call it when all layers
/// and rasters are there.
void write_styles_beside(const std::filesystem::path& folder);

}  // namespace talus::io
