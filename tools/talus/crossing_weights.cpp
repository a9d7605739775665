#include "crossing_weights.hpp"

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "talus/base/error.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/recorded_plan.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/simulate/plan/work_units.hpp"
#include "talus/simulate/scenario/frequency.hpp"

namespace {

namespace fs = std::filesystem;
using talus::io::CrossingTable;

std::uint32_t number_of(const std::string& text, const std::string& what) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw talus::InputError("screens.csv: " + what + " = '" + text +
                            "', must be a number, as talus run has written it; run the scenario again");
  return number;
}

/// A source cell or a block that the plan does not have.
[[noreturn]] void refuse(const std::string& value, std::uint64_t count, const std::string& what) {
  throw talus::InputError("screens.csv: " + value + ", but the plan has " + std::to_string(count) + " " + what +
                          "; run the scenario again");
}

/// Gives each crossing the events per year that its block stands for in the plan of the run, and the stratum of the
/// block: a unit of work, as for `talus hazard --objects`.
talus::WeightScale weigh(std::vector<talus::LineCrossing>& crossings, const CrossingTable& table,
                         const talus::Scenario& scenario) {
  const auto weights = talus::AnnualWeights::of(scenario);
  if (!weights) throw std::logic_error("a plan with frequencies has no weights");
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const std::uint32_t source = number_of(table.source[i], "source"), block = number_of(table.block[i], "block");
    if (source >= scenario.sources.size())
      refuse("source = " + table.source[i], scenario.sources.size(), "source cells");
    if (block >= scenario.trajectories)
      refuse("block = " + table.block[i], scenario.trajectories, "blocks of a source cell");
    const talus::Stratum stratum = talus::stratum_of(scenario, source, block);
    talus::LineCrossing& crossing = crossings[i];
    crossing.weight = static_cast<double>(weights->weight(scenario, source, block)) * weights->scale().unit;
    crossing.stratum = stratum.number;
    crossing.stratum_blocks = stratum.blocks;
  }
  return weights->scale();
}

}  // namespace

std::optional<talus::Bounded> Weighting::per_year(const talus::CrossingSums& counted) const {
  if (!scale) return std::nullopt;
  return talus::crossings_per_year(counted, line, *scale);
}

Weighting weigh_crossings(std::vector<talus::LineCrossing>& crossings, const CrossingTable& table,
                          const WeightingOptions& o) {
  if (o.unweighted) {
    if (!o.frequency.empty()) throw talus::InputError("--unweighted: cannot be given with --frequency; leave out one");
    return {"alike, as --unweighted asks", {}};
  }
  try {
    const auto file = talus::io::hazard_file_of(o.folder);
    if (!file && o.frequency.empty()) return {"alike: the run has no annual frequencies", {}};
    if (!file)
      throw talus::InputError("--frequency: the run in " + o.folder +
                              " has no annual frequencies that could be replaced; give the sources a field frequency, "
                              "or the scenario [frequency], and run again");
    const auto header = talus::io::read_hazard_header(*file);
    talus::io::require_plan_of_tally(o.folder, header.plan);
    auto loaded = talus::io::recorded_plan(o.folder, header.plan);
    talus::io::GivenFrequencies given;
    if (!o.frequency.empty()) given = talus::io::apply_weighting(o.frequency, loaded.scenario);
    const auto scale = weigh(crossings, table, loaded.scenario);
    return {"by the annual frequency " + (o.frequency.empty() ? "of its source" : "in " + o.frequency), scale, given};
  } catch (const talus::InputError& error) {
    throw talus::InputError(std::string(error.what()) + " (--unweighted counts every block alike)");
  }
}
