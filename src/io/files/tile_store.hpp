#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "talus/base/open_file.hpp"
#include "talus/io/files/staged_path.hpp"

namespace talus::io {

/// Where a compressed tile is in a file. Size 0: nowhere, all of its values are nodata.
struct TilePlace {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};

/// Compressed tiles, in the order in which they come, in a hidden file that goes with the object: a map is read from
/// its small overviews to its full resolution, but written the other way round.
class TileStore {
 public:
  /// @param beside  the file that is being written. Throws std::runtime_error
  explicit TileStore(const std::filesystem::path& beside);

  /// Adds a tile. From any thread. Throws std::runtime_error
  TilePlace add(std::span<const std::byte> tile);
  /// Reads a tile that was added. Throws std::runtime_error
  void read(const TilePlace& place, std::vector<std::byte>& tile) const;

 private:
  StagedPath staged_;
  OpenFile file_;
  std::atomic<std::uint64_t> end_ = 0;
};

}  // namespace talus::io
