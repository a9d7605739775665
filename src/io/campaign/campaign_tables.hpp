#pragma once
#include <string>
#include <unordered_map>
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

// Columns of every table of blocks.
inline constexpr Bounds kPlace{"x", "m", "map coordinate", -1e8, 1e8};
inline constexpr Bounds kMass{"mass_kg", "kg", "mass of the block", 0.0, 1e9, Bounds::AboveMin};
inline constexpr Bounds kDensity{"density_kgm3", "kg/m3", "mass per volume of the rock", 500.0, 8000.0};
inline constexpr Bounds kHoldout{"holdout", "1", "1: never used to fit", 0.0, 1.0, Bounds::Closed, true};

/// A table of a campaign. Its columns of remarks are not read, which is said.
CsvTable table_of_campaign(const std::string& path, std::vector<std::string> known,
                           const std::vector<std::string>& required, std::vector<std::string>& warnings);

/// Refuses a second row with the same id.
///
/// @param lines  by id, those of the rows so far
void refuse_second(const CsvTable& table, const CsvTable::Row& row, std::unordered_map<std::string, int>& lines);

/// The axes of a block in a row of a table: L1_m >= L2_m >= L3_m, or none of them and those of a sphere.
Vec3 axes_of(const CsvTable& table, const CsvTable::Row& row, double diameter);

}  // namespace talus::io
