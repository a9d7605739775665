#pragma once
#include <optional>
#include <string>
#include <vector>

#include "talus/io/gdal/crossings_file.hpp"
#include "talus/io/results/weighting_file.hpp"
#include "talus/products/barrier_design.hpp"
#include "talus/products/hazard.hpp"

/// What each crossing counts.
struct Weighting {
  std::string text;                         ///< "alike: ...", "by the annual frequency ..."
  std::optional<talus::WeightScale> scale;  ///< nothing where all count alike
  talus::io::GivenFrequencies given{};      ///< another weighting than the run's
  talus::CrossingSums line{};               ///< of all crossings of the line, once they have their weights

  /// How often crossings of the line come; nothing where all count alike.
  std::optional<talus::Bounded> per_year(const talus::CrossingSums& counted) const;
};

/// The weighting that is asked for.
struct WeightingOptions {
  std::string folder;     ///< of the run
  std::string frequency;  ///< file of another weighting; empty: that of the run
  bool unweighted = false;
};

/// Weighs the crossings of a run by the frequencies of their sources, where the run has some.
///
/// @param table  of the same crossings, in the same order
/// Throws InputError if the plan of the run cannot be read again.
Weighting weigh_crossings(std::vector<talus::LineCrossing>& crossings, const talus::io::CrossingTable& table,
                          const WeightingOptions& options);
