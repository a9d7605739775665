#pragma once
#include <string>
#include <vector>

#include "io/scenario/named_file.hpp"
#include "io/scenario/table_reader.hpp"
#include "talus/fit/campaign/campaign.hpp"
#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// The table [deposits] of campaign.toml: blocks that were mapped where they lie.
struct DepositSpec {
  bool given = false;
  NamedFile table, sources, mapped;
  Range release_height{1.0, 1.0};  ///< of sources without the field release_height [m]
  std::size_t strips = 0;          ///< across the slope; 0: none
  std::vector<double> held_out;    ///< numbers of the strips that never enter a fit, from 1
  std::vector<double> classes;     ///< limits between the classes of size [m]; empty: by the number of blocks
};

/// The file that a table of campaign.toml names; empty: none. One that is not there is a fault of the table.
NamedFile file_there(TableReader& table, const std::string& key, const std::filesystem::path& base);

/// Reads the table, without opening the files it names.
///
/// @param base  folder of campaign.toml
DepositSpec read_deposit_spec(TableReader table, const std::filesystem::path& base);

/// Reads the mapped blocks, the sources and the mapped polygons into a campaign that has its terrain already. Says how
/// many blocks are left out as they lie outside the polygons. Throws InputError.
void read_deposits(const DepositSpec& spec, const Terrain& terrain, Campaign& campaign,
                   std::vector<std::string>& warnings);

}  // namespace talus::io
