#pragma once
#include <filesystem>
#include <string>

#include "talus/simulate/simulate.hpp"
#include "talus/simulate/tally.hpp"

namespace talus::io {

/// Totals and tallies as a `Store` keeps them.
void put_totals(const Totals& totals, ByteWriter& out);
/// @param barriers  of the run that kept them
Totals get_totals(const Barriers& barriers, ByteReader& in);

/// The tally, region by region: number, length, bytes. Returns the checksum.
std::string write_tally(const std::filesystem::path& file, const Tally& tally);
/// Adds it to `tally`. Throws InputError where the file is damaged.
void read_tally(const std::filesystem::path& file, const std::string& sha256, Tally& tally);

}  // namespace talus::io
