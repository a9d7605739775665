#pragma once
#include <string>
#include <vector>

#include "talus/fit/campaign/campaign.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// A campaign with its origin: coordinate system, zone codes, input files, warnings.
struct LoadedCampaign {
  Campaign campaign;
  GeoReference geo;
  std::vector<std::string> zone_codes;  ///< by zone, as in the file of zones; empty for "default"
  std::string surface_from;             ///< origin of the kind of surface: "default", "campaign", "flag --surface"
  std::vector<InputFile> inputs;
  std::vector<std::string> warnings;  ///< one line each
};

/// Reads a campaign: campaign.toml, the terrain, the zones, and the tables blocks, stops, passages, screens, samples.
///
/// @param path     of campaign.toml; the paths in it are relative to its folder
/// @param surface  the flag --surface: overrides the key `surface` of the file
///
/// Throws InputError, one line with file, line, column, value and way out: what cannot be read, unknown keys and
/// columns, what is no number or out of bounds, a block twice, an id that blocks.csv lacks, a screen that screens.csv
/// lacks, axes that do not descend, a release off the terrain. docs/closing-the-loop.md, "Campaign".
LoadedCampaign read_campaign(const std::string& path, const std::optional<std::string>& surface = {});

}  // namespace talus::io
