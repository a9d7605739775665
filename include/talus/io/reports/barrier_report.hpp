#pragma once
#include <optional>
#include <string>
#include <vector>

#include "talus/products/barrier_design.hpp"
#include "talus/products/weibull.hpp"

namespace talus::io {

/// Fitted distribution of one quantity, and the probabilities that design values are exceeded. In the units of the
/// files.
struct Reliability {
  struct Limit {
    std::string name;  ///< "h_i", "SEL"
    double value;
    Exceedance exceeded;
  };
  std::string quantity, unit;  ///< "jump height", "m"
  WeibullFit fit;
  std::vector<Limit> limits;
};

/// Results of `talus barrier`.
struct BarrierReport {
  std::string screen;
  double released = 0.0;      ///< trajectories of the run
  std::size_t crossings = 0;  ///< blocks that crossed the screen
  std::string values;         ///< data of the fits: "simulated crossings", or the file of the observed ones
  std::string block_from;     ///< "the largest that crosses", "--volume"
  DesignBlock block;
  DesignFactors factors;
  BarrierDesign design{};
  std::vector<Reliability> reliability;
  double containment = 0.99;
  Stretch shortest{};            ///< shortest stretch of the line that holds `containment` of the crossings
  double bin = 0.0;              ///< width of a bin in the paper's rule [m]
  std::optional<Stretch> above;  ///< bins that more than 1 - containment of the released blocks cross
  std::vector<std::string> notes;
};

/// The report as a page for people, as JSON and as a table of one row per value. Energies in kJ.
std::string barrier_text(const BarrierReport& report);
std::string barrier_json(const BarrierReport& report);
std::string barrier_csv(const BarrierReport& report);

/// "barrier_road": the name of the files without ending; a character that a file name cannot have becomes '_'.
std::string barrier_file_name(const std::string& screen);

}  // namespace talus::io
