#pragma once
#include <filesystem>
#include <span>

#include "talus/fit/campaign/observe.hpp"
#include "talus/io/campaign/campaign_file.hpp"

namespace talus::io {

/// Writes the simulated measurements, errors included, one row per block and trial: `stops.csv`
/// (block,trial,end,x,y,mass_share), `passages.csv` (block,trial,screen,speed_ms,jump_height_m,angular_velocity_rads)
/// and, if the campaign has samples, `samples.csv` (block,trial,sample,speed_ms,angular_velocity_rads). Numbers are the
/// shortest that read back the same. Throws std::runtime_error.
void write_block_runs(const std::filesystem::path& folder, const LoadedCampaign& loaded,
                      std::span<const BlockRuns> runs);

}  // namespace talus::io
