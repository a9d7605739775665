#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "talus/products/hazard.hpp"

namespace talus {

/// Bounds above every net: of its capacity [J] and of its height [m]. docs/barrier.md, "Barriers in the walk".
inline constexpr double kLargestNetCapacity = 15e6, kHighestNet = 12.0;

/// Partial factors of UNI 11211-4. docs/barrier.md, "Design values".
struct DesignFactors {
  double trajectory = 1.10;  ///< gTr: 1.02 where the model was calibrated on the site, else 1.10 [-]
  double topography = 1.10;  ///< gDp: 1.02 for a good survey of the slope, else 1.10 [-]
  double volume = 1.10;      ///< gVol: 1.02 for a good survey of the blocks, else 1.10 [-]
  double density = 1.00;     ///< gG, of the mass per volume [-]
  double sel = 1.00;         ///< gE of the serviceability energy level [-]
  double mel = 1.30;         ///< gE of the maximum energy level: 1.30 as the paper, 1.20 in UNI 11211-4 [-]
  double freeboard = 0.5;    ///< smallest f_min [m]
  double percentile = 0.95;  ///< of speed and jump height, 0..1
};

/// The block that the barrier is designed for.
struct DesignBlock {
  double volume = 1.0;      ///< V [m^3]
  double density = 2700.0;  ///< rho [kg/m^3]
};

/// A block, or a piece of one, where it crosses a line.
struct LineCrossing {
  double speed = 0.0;                ///< [m/s]
  double height = 0.0;               ///< of its lowest point, vertical above the ground [m]
  double mass = 0.0;                 ///< [kg]
  double along = 0.0;                ///< distance from the start of the line [m]
  double weight = 1.0;               ///< events per year that it stands for, or 1 for every block; 0: it never falls
  std::size_t block = 0;             ///< number of the block: the pieces of a block have one
  std::uint64_t stratum = 0;         ///< of the block, as `AnnualShare::stratum`
  std::uint32_t stratum_blocks = 0;  ///< number of blocks in the stratum; 0: strata do not matter
  static constexpr std::size_t kUnknown = static_cast<std::size_t>(-1);
  std::size_t piece = kUnknown;  ///< number of the block, or piece of one, for several crossings of it

  double energy() const { return 0.5 * mass * speed * speed; }  ///< translational [J]
};

/// Quantile of a sample whose values count by weight: linear between the values, which stand at the middles of their
/// weights, stretched so that the smallest is at 0 and the largest at 1. Equal weights give exactly `quantile`.
///
/// @param values, weights  of equal number, not empty, any order; weights > 0;  share: 0..1
double weighted_quantile(std::span<const double> values, std::span<const double> weights, double share);

/// The weights of crossings, summed.
struct CrossingSums {
  double sum = 0.0;      ///< of all crossings
  double squares = 0.0;  ///< over the blocks, of the square of the sum of their crossings
  double overlap = 0.0;  ///< as `WeightSums::overlap`
  double largest = 0.0;  ///< largest sum of a block
  bool pieces = false;   ///< a block has several crossings: of its pieces
};

/// Sums the weights of crossings one by one.
class CrossingSummer {
 public:
  void add(const LineCrossing& crossing);
  const CrossingSums& sums() const { return sums_; }

 private:
  struct Stratum {
    double sum = 0.0, squares = 0.0;
    double overlap(std::uint32_t blocks) const;
  };
  CrossingSums sums_;
  std::unordered_map<std::size_t, double> blocks_;  // the weights of their crossings
  std::unordered_map<std::uint64_t, Stratum> strata_;
};

/// Sums the weights of all crossings.
CrossingSums sums_of(std::span<const LineCrossing> crossings);

/// How often blocks and pieces cross a line, or a part of it, with 95 % bounds [1/year].
///
/// Where no block has several crossings, `annual_frequency`: at most all events per year. Pieces cross more often than
/// blocks fall. They come together, so that the count is of blocks, each with the sum of its crossings:
/// `gamma_interval`, with the largest sum of a block at the line, but at least the largest weight of a block.
///
/// @param counted  the crossings that count; @param line  all crossings of the line
Bounded crossings_per_year(const CrossingSums& counted, const CrossingSums& line, const WeightScale& scale);

/// Number of crossings of equal weight that say as much: (sum w)^2 / sum w^2. Source: Kish, Survey Sampling (1965).
double effective_number(std::span<const LineCrossing> crossings);

/// Design values of a barrier.
struct BarrierDesign {
  double speed_percentile, height_percentile;  ///< v95 [m/s], h95 [m]
  double energy_percentile;                    ///< E95, translational [J]
  double speed;                                ///< v_d = v95 gTr gDp [m/s]
  double mass;                                 ///< m_d = V rho gVol gG [kg]
  double energy;                               ///< E_d = 1/2 m_d v_d^2 [J]
  double sel, mel;                             ///< gE E_d [J]
  double freeboard;                            ///< f_min: half the block, at least DesignFactors::freeboard [m]
  double height;                               ///< h_i = h95 gTr gDp + f_min, of the interception, vertical [m]
  double top;                                  ///< h_top = h95 gTr gDp + diameter, of the block's top, vertical [m]
};

/// @param crossings  not empty, any order; percentiles are by their weights
BarrierDesign design_barrier(std::span<const LineCrossing> crossings, const DesignBlock& block,
                             const DesignFactors& factors);

/// Fewest crossings from which a percentile is reported: 1 / (1 - percentile), so that at least one value may lie
/// above it.
std::size_t fewest_for_percentile(double percentile);

/// A part of a line.
struct Stretch {
  double from, to;  ///< distance from the start of the line [m]
  double share;     ///< share of the crossings within it [-]

  double width() const { return to - from; }
};

/// The shortest stretch that holds a share of the crossings, by their weights.
///
/// @param crossings  not empty, any order;  containment: above 0, at most 1
Stretch shortest_stretch(std::span<const LineCrossing> crossings, double containment);

/// The paper's rule: the stretch from the first to the last bin that is crossed by more than the share `probability` of
/// all released blocks, whatever their weights; the pieces of a block count once in a bin. It may hold far
/// fewer than 1 - probability of the crossings: its share says how many, by weight.
///
/// @param bin       width of the bins from the start of the line [m], > 0
/// @param released  number of all released blocks, each counting as one; `crossings` has only those that crossed
/// @return          nothing if no bin is crossed by so many
std::optional<Stretch> stretch_above(std::span<const LineCrossing> crossings, double bin, double released,
                                     double probability);

/// Edges of stretches along a line, from 0: each part of the line is cut into equal pieces, as few as are not longer
/// than `length`.
///
/// @param parts  lengths of the parts of the line [m];  length: [m], > 0
std::vector<double> stretch_edges(std::span<const double> parts, double length);

/// Shares of the crossings that exceed a design, by their weights.
struct DesignExceeded {
  double height, sel, mel;  // [-]
};

/// Design of the barrier along one stretch of a line, by the crossings of this stretch alone.
struct StretchDesign {
  Stretch stretch;            ///< with its share of the crossings of all stretches, by weight
  std::size_t crossings = 0;  ///< blocks and pieces
  CrossingSums sums;
  double effective = 0.0;                ///< `effective_number`
  double largest_energy = 0.0;           ///< of any crossing [J]
  double largest_height = 0.0;           ///< of any crossing [m]
  DesignBlock block;                     ///< given, or the largest that crosses here
  std::optional<BarrierDesign> design;   ///< nothing where the crossings are too few for the percentile
  std::optional<DesignExceeded> beyond;  ///< of the crossings of the stretch
};

/// The block to design for: its volume, or the largest that crosses.
struct DesignBlockRule {
  std::optional<double> volume;  ///< [m^3]
  double density = 2700.0;       ///< of the design block [kg/m^3]
  double rock_density = 2700.0;  ///< of the blocks that cross [kg/m^3]

  DesignBlock of(std::span<const LineCrossing> crossings) const;
};

/// A design for each stretch between two edges, by the first crossing of each block or piece on it. A crossing on an
/// edge belongs to the stretch that begins there; what lies beyond the last edge, by rounding, to the last stretch.
///
/// @param crossings  in the order of time; also those of blocks that have crossed another stretch before
///
/// A stretch has a design if its `effective_number` of crossings is enough for the percentile.
std::vector<StretchDesign> design_stretches(std::span<const LineCrossing> crossings, std::span<const double> edges,
                                            const DesignBlockRule& block, const DesignFactors& factors);

/// Shares of the crossings above h_i (their height), SEL and MEL (their energy), by weight.
DesignExceeded exceeded_by(std::span<const LineCrossing> crossings, const BarrierDesign& design);

}  // namespace talus
