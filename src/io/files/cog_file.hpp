#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "io/gdal/geotiff_tags.hpp"
#include "tile_store.hpp"

namespace talus::io {

/// A resolution of a map.
struct CogLevel {
  int columns, rows;             ///< pixels
  int across, down;              ///< tiles
  std::vector<TilePlace> tiles;  ///< row by row from the north-west

  TilePlace& tile(int x, int y) { return tiles[static_cast<std::size_t>(y) * across + static_cast<std::size_t>(x)]; }
};

/// What all tiles of a file have in common.
struct CogFormat {
  int side;  ///< pixels of a tile
  std::uint16_t compression;
  std::vector<TiffTag> tags;  ///< of GDAL; those of the size, the tiles and the compression are not taken over
  std::uint64_t most_small = (std::uint64_t{1} << 32U) - 1;  ///< bytes; a larger file is a BigTIFF
};

/// Writes a Cloud Optimized GeoTIFF: all directories, then the tiles of each overview from the smallest to the largest,
/// then those of the full resolution; row by row from the north-west. BigTIFF if it has more than 4 GB.
///
/// GDAL's own writer makes this layout from a whole uncompressed file; here the compressed tiles are there already. No
/// tile is shared by several places, though many are equal: libtiff would change all of them if it changes one.
///
/// @param levels   the full resolution first, each further one half as wide and high
/// @param proceed  called from time to time; false ends the writing
/// @return false if `proceed` ended it. Throws std::runtime_error
bool write_cog(const std::filesystem::path& path, const CogFormat& format, std::span<const CogLevel> levels,
               const TileStore& tiles, const std::function<bool()>& proceed);

}  // namespace talus::io
