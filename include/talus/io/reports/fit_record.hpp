#pragma once
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// Origin of a fit: the head of every report.
struct FitRecord {
  std::vector<std::string> command;
  std::vector<InputFile> inputs;
  std::vector<std::string> warnings;
  std::string campaign;
  std::string surface, surface_from;  ///< "creased"; "default", "campaign", "flag --surface"
};

}  // namespace talus::io
