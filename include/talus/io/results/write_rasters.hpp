#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/maps.hpp"

namespace talus::io {

class TileStore;

inline constexpr double kNodata = -9999.0;                 ///< of probabilities and quantities (Float32)
inline constexpr std::uint32_t kCountNodata = 4294967295;  ///< of counts (UInt32)

/// Folder and grid of the maps to write.
struct MapTarget {
  std::filesystem::path folder;
  GeoReference geo;
  int columns = 0, rows = 0;
  std::function<bool()> proceed;  ///< called from time to time, by all threads; false ends the writing. May be empty
};

/// A map that is written as the Cloud Optimized GeoTIFF `NAME.tif`, part by part, by any number of threads.
///
/// Needs memory for some tiles per thread and level of overviews, and room on the disk for the compressed map twice.
/// Where nothing happens, no cell is looked at: `Map::everywhere`.
///
/// Overviews: a pixel has the LARGEST value of the cells under it (nodata only if all are), band by band. Averages or
/// samples would thin out narrow paths, so that a hazard disappears from view when one zooms out. A return period has
/// the SMALLEST value, and a change the one farthest from 0, for the same reason.
/// Counts above 4294967294 are written as that. The bytes depend on the values only: no dates, no number of threads.
///
/// Nothing half-written is left if a part fails or is never written. The map and the target must outlive it.
class MapFile {
 public:
  MapFile(const Map& map, const MapTarget& target);
  ~MapFile();
  MapFile(const MapFile&) = delete;
  MapFile& operator=(const MapFile&) = delete;

  /// Number of parts, at least 1. Before the first is written.
  std::size_t parts() const;

  /// Where a part lies, counted in tiles along a curve that fills square after square; the same for all maps of a grid.
  /// Ascending from part to part. Before the first is written.
  std::uint64_t place_of(std::size_t i) const;

  /// Writes a part, each once, in any order and from any thread. The last one gives the file its name.
  ///
  /// @return true if the file is complete; false if other parts are missing, or if `proceed` ended it
  /// Throws std::runtime_error, one line with the file and the cause.
  bool write_part(std::size_t i);

 private:
  class Tiles;
  template <class T>
  class TilesOf;
  bool finish();
  template <class Work>
  void named(const Work& work);

  const Map& map_;
  const MapTarget& target_;
  std::unique_ptr<Tiles> tiles_;
  std::once_flag begun_;
  std::unique_ptr<TileStore> store_;  // from the first part to the last
  std::atomic<std::size_t> missing_;  // parts
};

}  // namespace talus::io
