#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/origin/origin.hpp"
#include "talus/simulate/scenario/acting_effects.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

struct ScenarioSpec;

/// A scenario with the record of its origin.
struct LoadedScenario {
  Scenario scenario;
  GeoReference geo;
  std::string complete_toml;  ///< every setting written out, paths absolute: becomes OUT/scenario.toml
  std::vector<Setting> settings;
  std::vector<InputFile> inputs;
  std::vector<Reprojection> reprojections;
  std::vector<EffectUse> effects;            ///< that are on, and where they act
  std::vector<std::string> notes;            ///< what was read, for `run` and `check`; one line each
  std::vector<std::string> warnings;         ///< one line each
  std::shared_ptr<const ScenarioSpec> spec;  ///< content of the file and the flags; null for a profile
  bool unread_height = false;                ///< the sources have a field height, which is not read
};

/// Settings of the command line. They override a scenario file or replace it.
struct RunFlags {
  std::string scenario;  ///< path of the TOML file; empty: from flags alone
  std::optional<std::string> dem, sources, sources_layer, screens, barriers, zones, zone_field, preset, surface,
      vectors, parameters;                        ///< `parameters`: a fitted model
  std::optional<double> diameter;                 ///< [m]
  std::optional<double> deformation_coefficient;  ///< c of the impact law
  std::optional<double> frequency;                ///< of all sources together [1/year]
  std::vector<double> thresholds;                 ///< of the energy [kJ]; empty: not given
  std::optional<std::uint32_t> trajectories;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> fields;   ///< "diameter=Durchmesser": names of fields of the sources
  std::vector<std::string> effects;  ///< "block-mass.preset=measured": keys of [effects]
  bool energy_total = false, count_rotation = false, bounds = false;
  /// Results whose scenario this is: its files may have been moved or copied together with them. The caller compares
  /// what the files hold.
  struct Recorded {
    std::string folder;         ///< of the results when they were written; empty: files are as they are named
    bool beside_first = false;  ///< the file beside the results counts also where the named one is there
  } recorded;
};

/// Reads and checks everything. Throws InputError, one line; `all_faults` gets every fault of the settings (for
/// `check`).
///
/// @param memory   for the rasters
/// @param threads  that read the DEM
LoadedScenario load_scenario(const RunFlags& flags, std::vector<std::string>* all_faults = nullptr,
                             const RasterMemory& memory = {}, int threads = 1);

/// Multiplies the trajectories by the number of rounds. Leaves `settings` as they are.
void set_rounds(LoadedScenario& loaded, std::uint32_t rounds);

}  // namespace talus::io
