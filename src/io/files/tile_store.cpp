#include "tile_store.hpp"

#include "posix_bytes.hpp"

namespace talus::io {

namespace fs = std::filesystem;

TileStore::TileStore(const fs::path& beside)
    : staged_(StagedPath::Kind::File, beside.parent_path() / (beside.stem().string() + "_tiles.tif"), ".tif"),
      file_(create_file(staged_.hidden())) {}

TilePlace TileStore::add(std::span<const std::byte> tile) {
  const TilePlace place{end_.fetch_add(tile.size()), static_cast<std::uint32_t>(tile.size())};
  write_bytes(file_, tile, place.offset);
  return place;
}

void TileStore::read(const TilePlace& place, std::vector<std::byte>& tile) const {
  tile.resize(place.size);
  read_bytes(file_, tile, place.offset);
}

}  // namespace talus::io
