#pragma once
#include <string>
#include <vector>

#include "talus/io/results/compared_runs.hpp"

namespace talus::io {

/// The figures as compare.csv: one row each, a column per run.
std::string comparison_csv(const std::vector<ComparedFigure>& figures);

/// The text of compare.md: tables of the folders, settings, rasters and screens, then the notes.
std::string comparison_markdown(const std::vector<ComparedFigure>& figures, const std::vector<std::string>& notes);

/// Record of a comparison.
struct ComparisonRecord {
  std::vector<std::string> command;  ///< words of the command line
  std::vector<std::string> folders;  ///< of the runs
  std::vector<std::string> notes;
  std::vector<std::string> files;  ///< written beside compare.json
};

/// The text of compare.json.
std::string comparison_json(const ComparisonRecord& record);

}  // namespace talus::io
