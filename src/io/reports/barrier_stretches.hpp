#pragma once
#include <string>

#include "io/files/json.hpp"
#include "talus/base/text.hpp"
#include "talus/io/reports/barrier_report.hpp"

namespace talus::io {

/// {"value", "low", "high"}
inline Json bounded_of(const Bounded& b) {
  return {{"value", b.value}, {"low", b.low}, {"high", b.high}};
}

/// The table of the stretches as text; empty without stretches.
std::string stretches_text(const BarrierReport& report);

/// The stretches as a list.
Json stretches_of(const BarrierReport& report);

/// Writes the stretches as lines with the columns of `stretches_csv` into a new GeoPackage, in the layer `name`.
void write_stretches(const std::filesystem::path& file, const std::string& name, const BarrierReport& report,
                     const Screen& line, const std::string& crs_wkt);

/// Whether a file is the layer that `write_stretches` writes, of this name.
bool is_of_design(const std::filesystem::path& file, const std::string& name);

}  // namespace talus::io
