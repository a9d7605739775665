#pragma once
#include <optional>
#include <span>
#include <vector>

namespace talus {

/// Partial factors of ETAG 027 and UNI 11211-4. docs/barrier.md, "Design values".
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

/// Design values of a barrier.
struct BarrierDesign {
  double speed_percentile, height_percentile;  ///< v95 [m/s], h95 [m]
  double speed;                                ///< v_d = v95 gTr gDp [m/s]
  double mass;                                 ///< m_d = V rho gVol gG [kg]
  double energy;                               ///< E_d = 1/2 m_d v_d^2 [J]
  double sel, mel;                             ///< gE E_d [J]
  double freeboard;                            ///< f_min: half the block, at least DesignFactors::freeboard [m]
  double height;                               ///< h_i = h95 gTr gDp + f_min, of the interception, vertical [m]
};

/// @param speeds   of the crossings [m/s];  heights: vertical, ground to centre [m]; none empty, any order
BarrierDesign design_barrier(std::span<const double> speeds, std::span<const double> heights, const DesignBlock& block,
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

/// The shortest stretch that holds a share of the crossings.
///
/// @param places  distances along the line [m], not empty, any order;  containment: above 0, at most 1
Stretch shortest_stretch(std::span<const double> places, double containment);

/// The paper's rule: the stretch from the first to the last bin that is crossed by more than the share `probability` of
/// all released blocks.
///
/// @param bin       width of the bins from the start of the line [m], > 0
/// @param released  number of all released blocks; `places` has only those that crossed
/// @return          nothing if no bin is crossed by so many
std::optional<Stretch> stretch_above(std::span<const double> places, double bin, double released, double probability);

}  // namespace talus
