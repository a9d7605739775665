#pragma once
#include <string>

namespace talus::io {

/// What the text of NAME.aux.xml says that changes the raster NAME: scale, offset, nodata, unit, place, system and the
/// like. Without what programs write that only show a raster (statistics, histograms, colours, other metadata). Empty
/// if nothing is left, or if GDAL cannot read the text.
std::string aux_that_counts(const std::string& text);

}  // namespace talus::io
