#pragma once
#include <optional>
#include <string>
#include <vector>

#include "markup.hpp"
#include "report_facts.hpp"
#include "report_fit.hpp"
#include "report_maps.hpp"
#include "report_screens.hpp"

namespace talus::io {

/// A point to look at before a report is signed, with what this run says of it.
struct Check {
  enum class Mark { Fine, Look, Act };
  Mark mark;
  std::string what, found, why;
};

/// What the checks look at.
struct CheckedRun {
  const RunFacts& run;
  const std::optional<HazardFacts>& hazard;
  const MapSheet& sheet;
  const ScreensPart& screens;
  const std::optional<FitPart>& fit;
  bool has_frequencies;  ///< the sources say how often blocks fall
};

/// "Before you sign": every point, in the order of the README.
std::vector<Check> checks_of(const CheckedRun& checked);
Markup checks_html(const std::vector<Check>& checks);
/// What the model takes for granted, with the choices of this run.
Markup assumptions_html(const CheckedRun& checked);

}  // namespace talus::io
