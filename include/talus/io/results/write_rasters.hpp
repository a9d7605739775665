#pragma once
#include <filesystem>
#include <functional>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/maps.hpp"

namespace talus::io {

inline constexpr double kNodata = -9999.0;                 ///< of probabilities and quantities (Float32)
inline constexpr std::uint32_t kCountNodata = 4294967295;  ///< of counts (UInt32)

/// Folder and grid of the maps to write.
struct MapTarget {
  std::filesystem::path folder;
  GeoReference geo;
  int columns = 0, rows = 0;
  std::function<bool()> proceed;  ///< called from time to time; false ends the writing. May be empty
};

/// Writes a map as the Cloud Optimized GeoTIFF `NAME.tif`, row by row in bounded memory: at most 128 rows at once.
/// Needs the size of the uncompressed map on the disk while it writes.
///
/// Overviews: a pixel has the LARGEST value of the cells under it (nodata only if all are), band by band. Averages or
/// samples would thin out narrow paths, so that a hazard disappears from view when one zooms out. A return period has
/// the SMALLEST value, for the same reason.
/// Counts above 4294967294 are written as that. The bytes depend on the values only: no dates, no number of threads.
///
/// Several maps may be written at the same time, one per thread.
///
/// @return false if `proceed` ended it
/// Throws std::runtime_error, one line with the file and the cause. Nothing half-written is left in either case.
bool write_map(const Map& map, const MapTarget& target);

}  // namespace talus::io
