#include "talus/io/results/write_block_runs.hpp"

#include <cmath>

#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/write_vectors.hpp"

namespace talus::io {
namespace {

std::string field(double value) {
  return std::isnan(value) ? "" : text_of(value);
}

}  // namespace

void write_block_runs(const std::filesystem::path& folder, const LoadedCampaign& loaded,
                      std::span<const BlockRuns> runs) {
  const Campaign& campaign = loaded.campaign;
  const Grid& grid = campaign.surface.grid();
  std::string stops = "block,trial,end,x,y,mass_share\n";
  std::string passages = "block,trial,screen,speed_ms,jump_height_m,angular_velocity_rads\n";
  std::string samples = "block,trial,sample,speed_ms,angular_velocity_rads\n";
  for (std::size_t b = 0; b < runs.size(); ++b) {
    const BlockRuns& r = runs[b];
    for (std::uint32_t t = 0; t < r.trials; ++t) {
      const std::string key = csv_field(campaign.blocks[b].id) + ',' + std::to_string(t) + ',';
      stops += key + name_of(r.end[t]) + ',' + field(r.x[t] + grid.west) + ',' + field(r.y[t] + grid.south) + ',' +
               field(r.mass_share[t]) + '\n';
      for (std::size_t s = 0; s < r.screens.size(); ++s)
        if (!std::isnan(r.screens[s].speed[t]))
          passages += key + csv_field(campaign.screens[s].id) + ',' + field(r.screens[s].speed[t]) + ',' +
                      field(r.screens[s].jump[t]) + ',' + field(r.screens[s].spin[t]) + '\n';
      for (std::size_t s = 0; s < r.samples.size(); ++s)
        if (!std::isnan(r.samples[s].speed[t]))
          samples +=
              key + std::to_string(s) + ',' + field(r.samples[s].speed[t]) + ',' + field(r.samples[s].spin[t]) + '\n';
    }
  }
  write_text(folder / "stops.csv", stops);
  write_text(folder / "passages.csv", passages);
  write_text(folder / "samples.csv", samples);
}

}  // namespace talus::io
