#pragma once
#include <optional>
#include <string>
#include <vector>

#include "markup.hpp"
#include "report_facts.hpp"
#include "talus/fit/score/intervals.hpp"

namespace talus::io {

/// The calibration, or the diagnosis, that made the ground of a run: the records beside the file that it includes.
struct FitPart {
  struct Number {
    std::string key, unit;
    double value = 0.0, low = 0.0, high = 0.0;
    bool identifiable = true, at_bound = false;
  };
  struct Error {
    std::string rows;  ///< "fitting rows", "held-out rows"
    double before = 0.0, after = 0.0, climatology = 0.0;
  };
  std::string file;      ///< fitted.toml
  std::string campaign;  ///< that it was fitted to
  std::string note;      ///< why the fit is not shown
  std::vector<Number> parameters;
  std::vector<Error> errors;
  std::string effect;  ///< verdict of the diagnosis; empty without one
  std::vector<std::string> warnings;
  Reduction skill;  ///< over the climatology, as the file says; NaN: it does not

  /// "3 of 6 fitted numbers are not identifiable"; empty where all are.
  std::string not_identifiable() const;
};

/// "no skill: -11.0 % (95 %: -25.0 to 2.0 %)", or that it has some, may have none, or that it is not known.
std::string skill_of_fit_text(const Reduction& skill);

/// Nothing if no number of the ground is of a fitted model. The records are read only if the model is the one of the
/// run.
std::optional<FitPart> read_fit_part(const RunFacts& run);
Markup fit_html(const std::optional<FitPart>& part);

}  // namespace talus::io
