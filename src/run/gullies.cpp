#include "talus/run/gullies.hpp"

#include "talus/base/text.hpp"
#include "talus/run/summary.hpp"

namespace talus::run {

io::GullyRecord gully_record(const GullyStops& stops, const Tally& tally, const io::LoadedScenario& loaded) {
  io::GullyRecord record{stops.blocks(), std::nullopt};
  if (const auto worst = stops.worst()) {
    const Grid& grid = tally.grid();
    const io::MapPlace place(loaded.geo, grid);
    const CellRecord* cell = tally.find(worst->column, worst->row);
    record.worst = {place.x(grid.centre_x(worst->column)), place.y(grid.centre_y(worst->row)), worst->blocks,
                    cell != nullptr ? cell->passages : 0U};
  }
  return record;
}

std::vector<std::string> gully_warnings(const io::GullyRecord& gullies, std::uint64_t released,
                                        const std::string& whole) {
  if (!(static_cast<double>(gullies.blocks) > io::kWarnedGullyShare * static_cast<double>(released))) return {};
  std::string text = share_text(gullies.blocks, released) + " of the " + whole + " (" + count_text(gullies.blocks) +
                     ") " + std::string(io::kGullyWarning) +
                     ": there the cells of the DEM are a staircase whose treads hold blocks that would go on in the "
                     "real gully, so that the maps may end too early";
  if (const auto& worst = gullies.worst)
    text += "; most stay at x = " + with_decimals(worst->x, 1) + ", y = " + with_decimals(worst->y, 1) + ": " +
            count_text(worst->blocks) + " of the " + count_text(worst->passages) + " blocks that cross this cell";
  return {
      text +
      "; take a survey with smaller cells; else run on this DEM resampled by gdalwarp -r cubicspline, too, and take "
      "the higher hazard: docs/prepare-data.md, \"Resampling\""};
}

}  // namespace talus::run
