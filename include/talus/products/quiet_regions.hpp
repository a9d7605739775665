#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "talus/products/cell_window.hpp"
#include "talus/simulate/plan/region.hpp"
#include "talus/terrain/grid.hpp"

namespace talus {

/// What the cells of a rectangle have in common.
enum class Quiet : std::uint8_t {
  Terrain,    ///< all have terrain, and nothing happens in them
  NoTerrain,  ///< none has terrain, and nothing happens in them
  No          ///< neither, or it is not known
};

/// State of a window where nothing happens. @param terrain  number of its cells with terrain
Quiet quiet_of(std::size_t terrain, const CellWindow& window);

/// Where nothing happens, by regions of 64 x 64 cells: most of a large map. The values of such a part are known without
/// a look at its cells.
class QuietRegions {
 public:
  /// @param look  tells about a region, which lies in this window; regions are numbered as in `Tally`
  QuietRegions(const Grid& grid, const std::function<Quiet(std::size_t region, const CellWindow& window)>& look);

  Quiet of(const CellWindow& window) const;

 private:
  Regions layout_;
  std::vector<Quiet> regions_;
};

}  // namespace talus
