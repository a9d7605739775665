#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "markup.hpp"

namespace talus::io {

/// What crosses the screens of a run: their tables in the folder.
struct ScreensPart {
  /// A row of screens_summary.csv.
  struct Row {
    std::string screen, quantity, unit;
    double crossings = 0.0, blocks = 0.0, share = 0.0, p50 = 0.0, p95 = 0.0, p99 = 0.0, maximum = 0.0;
    std::vector<double> counts;  ///< crossings by value, in equal steps from 0 to the maximum; empty if not known
  };
  std::vector<Row> rows;
  std::string note;
};

/// Throws InputError if a table is there and cannot be understood. No rows without screens.
ScreensPart read_screens_part(const std::filesystem::path& folder);
Markup screens_html(const ScreensPart& part);

}  // namespace talus::io
