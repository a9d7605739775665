#pragma once
#include <string>

namespace talus {

/// The energy that thresholds, frequencies, classes and objects of a run count, in words.
struct EnergyWords {
  std::string noun;    ///< in titles of rasters
  std::string name;    ///< in bands, on pages and in titles of layers
  std::string symbol;  ///< in bands
  std::string remark;  ///< after a word that does not tell which energy it is of
};

inline const EnergyWords& energy_words(bool with_rotation) {
  static const EnergyWords translational{"translational kinetic energy", "translational energy", "E",
                                         " (translational energy)"};
  static const EnergyWords total{"total kinetic energy (with rotation)", "energy with rotation", "E with rotation",
                                 " (energy with rotation)"};
  return with_rotation ? total : translational;
}

}  // namespace talus
