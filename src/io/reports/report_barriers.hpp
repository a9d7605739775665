#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "markup.hpp"
#include "report_facts.hpp"
#include "talus/io/reports/barrier_report.hpp"

namespace talus::io {

/// The design of a barrier that `talus barrier` has written beside the run.
struct BarrierPart {
  struct Value {
    std::string name, unit, from;
    double value = 0.0;
  };
  struct Limit {
    std::string quantity, name, unit;
    double value = 0.0, weibull = 0.0, share = 0.0, share_low = 0.0, share_high = 0.0, years = 0.0;  ///< 0: not known
    bool rarer = false;  ///< than once in `years`, which is then a 95 % bound
    bool agrees = false;
  };
  struct Stretch {
    double from = 0.0, to = 0.0, crossings = 0.0, sel = 0.0, mel = 0.0, height = 0.0;  ///< 0: too few for a design
  };
  std::string screen, weighting;
  double crossings = 0.0, blocks = 0.0;  ///< fewer blocks: pieces of them cross, too
  std::vector<Value> design;
  std::vector<Limit> limits;
  std::vector<OnceIn> once_in;
  std::vector<Stretch> stretches;
  std::vector<std::string> notes;
  FrequencyFacts frequency{};  ///< of the design

  double value(const std::string& name) const;  ///< 0 if there is none
};

/// The files barrier_*.json of a folder, by name; with a note if one counts by other frequencies than the hazard maps.
/// Throws InputError if one cannot be understood.
std::vector<BarrierPart> read_barrier_parts(const std::filesystem::path& folder,
                                            const std::optional<HazardFacts>& hazard);
/// The barriers that stood in the run, as a table; nothing if there were none.
Markup standing_html(const RunFacts& run);
Markup barriers_html(const std::vector<BarrierPart>& parts);

}  // namespace talus::io
