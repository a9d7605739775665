#pragma once
#include <string>
#include <vector>

#include "talus/fit/calibrate/uncertainty.hpp"
#include "talus/fit/score/distributions.hpp"
#include "talus/io/reports/fit_record.hpp"
#include "talus/io/reports/score_report.hpp"

namespace talus::io {

/// Results of `talus calibrate`.
struct Calibration : FitRecord {
  FitOptions options;
  Model start;
  std::string start_name;  ///< a preset, everywhere, or the file of a model
  std::vector<Parameter> free;
  std::vector<std::string> untouched;  ///< zones whose parameters stayed, because too few simulated paths touch them
  Fit fit;
  Uncertainty uncertainty;
  std::uint32_t score_trials = 100;
  std::vector<BeforeAfter> errors;  ///< of the fitting and the held-out rows, with trials that the search has not used
  Comparison comparison;            ///< of all blocks, after the fit
};

/// The text of calibration.json.
std::string calibration_json(const Calibration& calibration);
/// The text of report.md: the same for people.
std::string calibration_report(const Calibration& calibration);

/// "5.2 % (95 % interval over the blocks: 1.0 to 9.4 %)", or that it cannot be told.
std::string gain_of_fit(const BeforeAfter& error);

/// Remark on a 95 % interval: "not identifiable", "ends at the bound of the search", both, or nothing.
std::string interval_note(bool identifiable, bool at_bound);
/// Warns of an interval that the bound of the search may cut short.
std::string bound_warning(const std::string& key, const Interval& interval);

}  // namespace talus::io
