#include "talus/run/write_maps.hpp"

#include <atomic>
#include <exception>
#include <memory>

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
};

}  // namespace

// The parts of all maps are one list, so that no thread waits at the end of a map. An exception must not leave the
// parallel region: the first one is kept and thrown after it; the other parts are left out.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads) {
  std::vector<std::unique_ptr<io::MapFile>> files;
  std::vector<Part> parts;
  for (const Map* const map : missing_maps(maps, target.folder)) {
    files.push_back(std::make_unique<io::MapFile>(*map, target));
    for (std::size_t i = 0; i < files.back()->parts(); ++i) parts.push_back({map, files.back().get(), i});
  }
  std::exception_ptr failure;
  std::atomic<bool> failed = false;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) default(none) shared(parts, target, failure, failed)
  for (const Part& part : parts) {
    if (failed) continue;
    try {
      if (part.file->write_part(part.i)) io::write_style(target.folder, *part.map);
    } catch (...) {
#pragma omp critical
      if (!failure) failure = std::current_exception();
      failed = true;
    }
  }
  if (failure) std::rethrow_exception(failure);
  if (target.proceed && !target.proceed()) stop_interrupted();
}

}  // namespace talus::run
