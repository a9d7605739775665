#include "talus/run/write_maps.hpp"

#include <algorithm>
#include <exception>

#include "talus/io/results/style.hpp"
#include "talus/run/observer.hpp"

namespace talus::run {

// An exception must not leave the parallel region: the first one is kept and thrown after it.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads) {
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(std::min(threads, kMapsAtOnce)) default(none) \
    shared(maps, target, failure)
  for (const Map& map : maps) {
    try {
      const bool there =
          std::filesystem::exists(target.folder / (map.name + ".tif"));  // written before the run was killed
      if (there || io::write_map(map, target)) io::write_style(target.folder, map);
    } catch (...) {
#pragma omp critical
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  if (target.proceed && !target.proceed()) stop_interrupted();
}

}  // namespace talus::run
