#include "talus/run/write_maps.hpp"

#include <algorithm>
#include <memory>

#include "base/in_threads.hpp"
#include "talus/io/results/style.hpp"
#include "talus/run/observer.hpp"

namespace talus::run {

namespace {

/// The maps that are missing. A killed run may have written some.
std::vector<const Map*> missing_maps(const std::vector<Map>& maps, const std::filesystem::path& folder) {
  std::vector<const Map*> missing;
  for (const Map& map : maps)
    if (std::filesystem::exists(folder / (map.name + ".tif")))
      io::write_style(folder, map);
    else
      missing.push_back(&map);
  return missing;
}

/// Part of a map.
struct Part {
  const Map* map;
  io::MapFile* file;
  std::size_t i;
  std::uint64_t square;
};

constexpr std::uint64_t kTilesOfSquare = 16;  // a power of 4; at most half a gigabyte of records

}  // namespace

// The parts of all maps are one list, so that no thread waits at the end of a map. It goes square by square, so that
// all maps need the same records one after the other. In a square it goes map by map: overviews that lie within the
// square grow for one map at a time.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads) {
  std::vector<std::unique_ptr<io::MapFile>> files;
  std::vector<Part> parts;
  for (const Map* const map : missing_maps(maps, target.folder)) {
    files.push_back(std::make_unique<io::MapFile>(*map, target));
    for (std::size_t i = 0; i < files.back()->parts(); ++i)
      parts.push_back({map, files.back().get(), i, files.back()->place_of(i) / kTilesOfSquare});
  }
  std::ranges::stable_sort(parts, {}, &Part::square);
  in_parallel(parts.size(), threads, [&](std::size_t i) {
    if (parts[i].file->write_part(parts[i].i)) io::write_style(target.folder, *parts[i].map);
  });
  if (target.proceed && !target.proceed()) stop_interrupted();
}

}  // namespace talus::run
