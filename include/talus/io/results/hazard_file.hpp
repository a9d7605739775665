#pragma once
#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus::io {

/// The name of the file in a folder of results.
inline constexpr const char* kHazardFile = "hazard_tally.gz";

/// Header of a hazard file: everything but the cells.
struct HazardHeader {
  std::string version;  ///< of the program that wrote it
  std::string plan;     ///< `plan_checksum`
  Grid grid;
  GeoReference geo;
  HazardRules rules;
  std::int64_t left_weight = 0;  ///< `Totals::left_weight`
  double passages_below = 0.0;   ///< `OutputSettings::passages_below`
};

/// Events per year of which the block, or a piece of it, leaves the terrain. No more than there are: weights of classes
/// that were drawn more often than expected may sum to more.
inline double left_per_year(const HazardHeader& header) {
  return std::min(static_cast<double>(header.left_weight) * header.rules.scale.unit, header.rules.scale.total);
}

/// A row of cells. Row 0 is the southern one.
struct HazardRow {
  int row = 0;
  std::vector<bool> terrain;      ///< by column
  std::vector<HazardAt> touched;  ///< by column, from the west
};

/// Writes the annual frequencies of a tally, compressed. docs/hazard.md, "What a run keeps".
///
/// @param left_weight  Totals::left_weight of the run
/// The bytes depend on the values only. Throws std::runtime_error on a full disk; no half file is left.
void write_hazard(const std::filesystem::path& file, const LoadedScenario& loaded, const Tally& tally,
                  std::int64_t left_weight);

/// Reads such a file, row by row in bounded memory, from the north.
///
/// @param begin  called once before the rows
/// Throws InputError, one line with the way out: if the file is missing, is no hazard file, was written by a later
/// version, or its bytes have changed. The checksum over all bytes is compared after the last row.
HazardHeader read_hazard(const std::filesystem::path& file, const std::function<void(const HazardHeader&)>& begin,
                         const std::function<void(const HazardRow&)>& visit);

/// The hazard file of a run; nothing if its sources have no frequencies. Throws InputError if it is lost: the record of
/// the run lists it.
std::optional<std::filesystem::path> hazard_file_of(const std::filesystem::path& folder);

/// The header alone; reads the whole file, to compare its checksum. Throws as `read_hazard`.
inline HazardHeader read_hazard_header(const std::filesystem::path& file) {
  return read_hazard(
      file, [](const HazardHeader&) {}, [](const HazardRow&) {});
}

}  // namespace talus::io
