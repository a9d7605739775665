#pragma once
#include <string>
#include <vector>

#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/weighting_file.hpp"
#include "talus/products/hazard_matrix.hpp"

namespace talus::io {

/// Reads a matrix of classes from a TOML file: energies, years, classes, names; keys that are not given have the
/// default. Throws InputError with file, line, key, value and what is allowed.
HazardMatrix read_matrix(const std::string& path);

/// Record of `talus hazard`.
struct HazardRecord {
  std::vector<std::string> command;
  HazardHeader header;
  HazardMatrix matrix;
  std::string matrix_file;  ///< empty: the default
  std::uint64_t cells = 0;  ///< cells that any block passes
  double width = 0.0;       ///< of the object [m]; 0: the cell
  bool curves = false;      ///< hazard_curves.tif was asked for
  std::string objects_file;
  GivenFrequencies frequency;  ///< another weighting than the run's
  std::vector<std::string> warnings, files;
};

/// The text of hazard.json.
std::string hazard_json(const HazardRecord& record);

/// The file of other frequencies with which the hazard in a folder was made; empty: none, or there is no hazard.
/// Throws InputError if its hazard.json cannot be read.
std::string frequency_file_of(const std::filesystem::path& folder);

}  // namespace talus::io
