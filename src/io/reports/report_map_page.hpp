#pragma once
#include "map_furniture.hpp"
#include "markup.hpp"
#include "report_maps.hpp"

namespace talus::io {

/// The pictures, outlines and furniture that the drawings of a page share; they show nothing by themselves.
Markup map_store(const MapSheet& sheet, const RunFacts& run, const MapImprint& imprint);
/// Two maps with a slider between them, and the table of the values at the clicked place; for the screen only.
Markup map_viewer(const MapSheet& sheet);
/// A figure for each map that is printed.
Markup map_figures(const MapSheet& sheet, const MapImprint& imprint);

}  // namespace talus::io
