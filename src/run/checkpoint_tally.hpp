#pragma once
#include <filesystem>
#include <string>

#include "talus/simulate/simulation.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus::run {

/// Totals as bytes, between processes and in a `Checkpoint`.
void put_totals(const Totals& totals, ByteWriter& out);
/// @param barriers  of the run that saved the totals
Totals get_totals(const Barriers& barriers, ByteReader& in);

/// Writes them into a file. Returns the checksum.
std::string write_totals(const std::filesystem::path& file, const Totals& totals);
/// Throws InputError if the file is damaged.
Totals read_totals(const std::filesystem::path& file, const std::string& sha256, const Barriers& barriers);

/// Writes a tally region by region: number, length, bytes. Returns the checksum.
std::string write_tally(const std::filesystem::path& file, const Tally& tally);
/// Adds a saved tally to `tally`. Throws InputError if the file is damaged.
void read_tally(const std::filesystem::path& file, const std::string& sha256, Tally& tally);

/// Writes the cells that each source cell has reached, one source cell after the other: length, bytes. Returns the
/// checksum.
std::string write_reaches(const std::filesystem::path& file, const Simulation& simulation);
void read_reaches(const std::filesystem::path& file, const std::string& sha256, Simulation& simulation);

}  // namespace talus::run
