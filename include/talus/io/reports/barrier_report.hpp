#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/results/weighting_file.hpp"
#include "talus/products/barrier_design.hpp"
#include "talus/products/hazard.hpp"
#include "talus/products/weibull.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// The height of the block's centre above the ground, as a quantity: where it is above h_i the block passes the net.
inline constexpr const char* kCentre = "centre height";

/// Fitted distribution of one quantity, and the probabilities that design values are exceeded. In the units of the
/// files.
struct Reliability {
  struct Limit {
    std::string name;  ///< "h_i", "SEL"
    double value;
    Exceedance exceeded;
    std::optional<double> by_frequency;  ///< share of the crossings that exceed it, by their weights
    std::optional<Bounded> per_year;     ///< crossings that exceed it [1/year]
  };
  std::string quantity, unit;  ///< "jump height", "m"; `kCentre`
  WeibullFit fit;
  std::vector<Limit> limits;
};

/// Design along one stretch of the line.
struct StretchRow {
  StretchDesign values;
  std::optional<Bounded> per_year;  ///< crossings [1/year]
};

/// Energy, jump height, height of the centre and speed that blocks reach at the line once in some years. In the units
/// of the files.
struct OnceIn {
  double years;
  Bounded energy, height, centre, speed;  ///< [kJ], [m], [m], [m/s]; 0: crossings are rarer; infinite or NaN: not known
};

/// How wide a barrier must be.
struct BarrierWidth {
  Stretch shortest{};            ///< shortest stretch of the line that holds `containment` of the crossings
  double bin = 0.0;              ///< width of a bin in the paper's rule [m]
  std::optional<Stretch> above;  ///< bins that more than 1 - containment of the released blocks cross
};

/// Results of `talus barrier`.
struct BarrierReport {
  std::string screen;
  double without_height = 0.0;      ///< share of the line where the DEM has no height, and no block can cross
  double released = 0.0;            ///< trajectories of the run
  std::size_t crossings = 0;        ///< of the screen by blocks and pieces
  std::size_t blocks = 0;           ///< blocks of which something crossed
  std::size_t never = 0;            ///< of the crossings: of sources with a frequency of 0, in no stretch
  std::string weighting;            ///< what each block and piece counts: "alike: ...", "by the annual frequency ..."
  GivenFrequencies frequency;       ///< another weighting than the run's
  double events_per_year = 0.0;     ///< of all blocks of the run; 0 where all count alike
  double effective = 0.0;           ///< number of crossings of equal weight that say as much
  std::optional<Bounded> per_year;  ///< crossings [1/year]; nothing without frequencies
  std::string values;               ///< data of the fits: "simulated crossings", or the file of the observed ones
  std::string block_from;           ///< "the largest that crosses", "--volume"
  DesignBlock block;
  DesignFactors factors;
  BarrierDesign design{};
  std::vector<Reliability> reliability;
  std::vector<OnceIn> once_in;  ///< none without frequencies
  double containment = 0.99;
  std::optional<BarrierWidth> width;  ///< nothing on a profile, which has no width
  double longest = 30.0;              ///< of a stretch [m]
  std::vector<StretchRow> stretches;  ///< none on a profile
  std::vector<std::string> notes;

  bool pieces() const { return crossings > blocks; }  ///< pieces of broken blocks cross, too
};

/// How often simulated crossings exceed a limit: "0.5 % of the simulated crossings, once in 310 years [250, 410]".
/// Empty without frequencies.
std::string frequency_text(const Reliability::Limit& limit);

/// A value that is reached once in some years: "12 [8, 20]"; "?" for what is not known.
std::string value_once_text(const Bounded& value);

/// The report as a page for people, as JSON and as a table of one row per value. Energies in kJ.
std::string barrier_text(const BarrierReport& report);
std::string barrier_json(const BarrierReport& report);
std::string barrier_csv(const BarrierReport& report);  // the law's columns are empty where it departs

/// Writes NAME.json, NAME.csv, NAME_stretches.csv and NAME.gpkg, the stretches on the map, into a folder. Throws
/// InputError, before anything is written, if a file of such a name is there that no design of Talus has left: it is
/// someone's own.
///
/// @param line     the screen, in map coordinates [m]
/// @param crs_wkt  coordinate system of the map; empty if it has none
/// @return a line that says which design is replaced, if it was another one
std::optional<std::string> write_barrier(const std::filesystem::path& folder, const std::string& name,
                                         const BarrierReport& report, const Screen& line, const std::string& crs_wkt);

/// The stretches as a table, one row each.
std::string stretches_csv(const BarrierReport& report);

/// A sentence if blocks have more energy than SEL, or their centre is above h_i, more often than once in the longest of
/// the return periods, or if they may by the upper bounds.
std::optional<std::string> often_note(const BarrierReport& report);

/// A sentence if a part of the line lies where the DEM has no height.
std::optional<std::string> gap_note(double without_height);

/// A sentence if some stretch needs more than the one design of the whole line.
std::optional<std::string> stretch_note(const BarrierReport& report);

/// A sentence if a block exceeds the design of the whole line on a stretch with too few crossings for a design.
std::optional<std::string> undesigned_note(const BarrierReport& report);

}  // namespace talus::io
