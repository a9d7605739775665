#pragma once
#include <string>
#include <vector>

#include "talus/base/bounds.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/trace.hpp"
#include "talus/simulate/scenario/vector_format.hpp"

namespace talus {

/// A closed interval from which a value is drawn uniformly; one value where both ends are equal.
struct Range {
  double low = 0.0, high = 0.0;
  double at(double share) const { return low + (high - low) * share; }
  bool operator==(const Range&) const = default;
};

/// A feature of the source layer, with the settings of its blocks. NaN: the value of the scenario holds.
struct SourceFeature {
  std::string name;
  double frequency = kNotGiven;          ///< events per year of the whole feature
  Range diameter{kNotGiven, kNotGiven};  ///< [m]
  Range release_height{1.0, 1.0};        ///< above the terrain [m]
  Vec3 velocity = Vec3::Zero();          ///< at the release [m/s]
  std::int64_t id = -1;                  ///< number in its file (FID); -1: of no file
  bool has_area = true;                  ///< drawn as polygons alone: its cells are an area of rock
  double drawn_area = kNotGiven;         ///< of its polygons where the DEM has heights, in plan [m^2]; NaN: not known
};

/// One place of release: a cell of the grid, or a point of its own.
struct SourceCell {
  std::uint32_t feature = 0;  ///< index into Scenario::features
  double x = 0.0, y = 0.0;    ///< centre of the cell, or the point [m, local]
  bool point = false;         ///< released exactly there, not uniformly in the cell
  double along = 0.0;         ///< of a point: releases are uniform in x over this length around it [m]
};

/// A class of block sizes, with its share of the blocks.
struct BlockClass {
  Range diameter;                ///< [m]
  double weight = 1.0;           ///< relative, > 0
  double frequency = kNotGiven;  ///< events per year
};

/// Volumes with N(>= V) proportional to V^-exponent between two bounds.
struct VolumePowerLaw {
  Range volume{0.0, 0.0};  ///< [m^3]; high = 0: no power law
  double exponent = 1.0;
};

/// How large the blocks are: classes, or a power law of volume.
struct Blocks {
  std::vector<BlockClass> classes;
  VolumePowerLaw power_law;
  double density = 2700.0;   ///< [kg/m^3]
  Vec3 axes = Vec3::Ones();  ///< L1 >= L2 >= L3 relative to each other, for effects that need a shape
};

/// A line whose crossings are recorded.
struct Screen {
  std::string id;
  std::vector<std::vector<Eigen::Vector2d>> lines;  ///< [m, local]; more than one where the feature has parts
};

/// Frequencies given for the whole scenario; features and classes of blocks may have their own. docs/hazard.md.
struct FrequencyRules {
  bool by_true_area = false;    ///< shares of source cells follow the area of their surface; else equal
  bool class_shares = false;    ///< frequencies of classes of blocks are only their shares of the events
  double total = kNotGiven;     ///< events per year of all sources together
  double per_area = kNotGiven;  ///< events per area and year [1/(m^2 year)]
  double scale = kNotGiven, exponent = kNotGiven;  ///< A [1/year] and b of N(>= V) = A V^-b, V in m^3
};

/// Settings of the results.
struct OutputSettings {
  std::vector<double> energy_thresholds{30.0, 300.0};    ///< [kJ], ascending
  std::vector<double> height_thresholds{1.0, 2.0, 4.0};  ///< vertical, above the terrain [m], ascending
  std::uint32_t paths = 500;                             ///< trajectories written as vectors
  double passages_below = 0.0;  ///< only passages lower than this count in passage densities [m]; 0: at any height
  bool energy_total = false;    ///< the energy with rotation is kept per cell
  bool count_rotation = false;  ///< thresholds and hazard count the energy with rotation, not the translational one
  bool bounds = false;          ///< bounds of percentiles are written
  VectorFormat vectors = VectorFormat::GeoPackage;  ///< of stops, exits, paths and screens

  /// Whether the energy with rotation is kept per cell.
  bool keeps_total() const { return energy_total || count_rotation; }
};

/// All settings and data of a run: built by `make_scenario`, then constant. Everything is on one grid, in local metres.
struct Scenario {
  Surface surface{Raster<float>{}};
  Cover cover;
  std::vector<std::string> zone_names;  ///< of cover.grounds
  std::vector<SourceFeature> features;
  std::vector<SourceCell> sources;
  Blocks blocks;
  std::vector<Screen> screens;
  Barriers barriers;
  ImpactModel impact;
  Effects effects;
  bool drag_and_stems = false;  ///< vegetation-drag and forest-stems may act at the same place
  int day = 0;                  ///< of the run, for effects that change with it
  EndRules rules;
  OutputSettings output;
  FrequencyRules frequency;
  std::uint64_t seed = 1;
  std::uint32_t trajectories = 100;  ///< per source cell

  World world() const {
    return {surface, cover, impact, rules, effects.any() ? &effects : nullptr, barriers.empty() ? nullptr : &barriers};
  }
  std::uint64_t released() const { return std::uint64_t{trajectories} * sources.size(); }
};

/// Checks the parts and returns them as a scenario. Throws InputError with key, value, range and unit.
Scenario make_scenario(Scenario parts);

}  // namespace talus
