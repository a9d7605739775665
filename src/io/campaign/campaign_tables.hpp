#pragma once
#include <span>
#include <string>
#include <vector>

#include "io/gdal/csv_table.hpp"
#include "talus/fit/campaign/campaign.hpp"

namespace talus::io {

/// Paths of the tables of a campaign; empty: not given.
struct CampaignFiles {
  std::string blocks, stops, passages, samples;
};

/// Reads the blocks and their measurements into a campaign that has its terrain and screens already.
/// Map coordinates become local ones by the campaign's grid. Throws InputError.
void read_tables(const CampaignFiles& files, Campaign& campaign, std::vector<std::string>& warnings);

/// The axes of a block in a row of a table: L1_m >= L2_m >= L3_m, or none of them and those of a sphere.
Vec3 axes_of(const CsvTable& table, const CsvTable::Row& row, double diameter);

/// Warns once if masses contradict axes and density: a mass in tonnes, axes in cm. Spheres of their mass never do.
void warn_of_masses(const std::string& path, std::span<const MeasuredBlock> blocks, std::vector<std::string>& warnings);

}  // namespace talus::io
