#pragma once
#include <filesystem>
#include <string>

#include "talus/simulate/simulation.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus::run {

/// Totals and tallies as a `Checkpoint` keeps them.
void put_totals(const Totals& totals, ByteWriter& out);
/// @param barriers  of the run that kept them
Totals get_totals(const Barriers& barriers, ByteReader& in);

/// The tally, region by region: number, length, bytes. Returns the checksum.
std::string write_tally(const std::filesystem::path& file, const Tally& tally);
/// Adds it to `tally`. Throws InputError where the file is damaged.
void read_tally(const std::filesystem::path& file, const std::string& sha256, Tally& tally);

/// Which cells the source cells have reached, one after the other: length, bytes. As the tally.
std::string write_reaches(const std::filesystem::path& file, const Simulation& simulation);
void read_reaches(const std::filesystem::path& file, const std::string& sha256, Simulation& simulation);

}  // namespace talus::run
