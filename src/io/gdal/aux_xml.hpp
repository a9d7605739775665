#pragma once
#include <string>

namespace talus::io {

/// The entries of a text NAME.aux.xml that change the raster NAME: scale, offset, nodata, unit, place, system, which
/// band is alpha. Statistics, histograms and other metadata, which viewers write, are left out. Empty if nothing
/// remains, or if GDAL cannot read the text.
std::string aux_that_counts(const std::string& text);

}  // namespace talus::io
