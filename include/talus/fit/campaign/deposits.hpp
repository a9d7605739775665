#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "talus/fit/campaign/campaign.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// A cell, or a point, from which mapped blocks may have come.
struct DepositSource {
  Vec3 place = Vec3::Zero();       ///< its centre, on the terrain [m, local]
  double area = 0.0;               ///< of its ground, not in plan [m2], > 0
  bool point = false;              ///< blocks start exactly there, not anywhere in the cell
  Range release_height{1.0, 1.0};  ///< of a block's lowest point above the terrain [m]
  Vec3 velocity = Vec3::Zero();    ///< at the release [m/s]
};

/// The sources of blocks that were mapped where they lie, and the region that was mapped. Their releases are not known.
/// docs/mapped-deposits.md.
struct MappedDeposits {
  std::vector<DepositSource> sources;  ///< at least one
  std::vector<double> share;           ///< of the area, up to and including each source; the last is 1
  Raster<std::uint8_t> region;         ///< 0: not mapped; a simulated stop counts for blocks of its own region
  Raster<std::uint32_t> nearest;       ///< the source nearest in plan to the centre of each cell
  std::vector<double> limits;          ///< between the classes of size: diameters [m], ascending; may be empty
  std::vector<std::vector<Eigen::Vector2d>> anywhere;  ///< by region: places drawn evenly from it
};

/// Number of places that stand for blocks lying anywhere in a region.
inline constexpr std::uint32_t kAnywhere = 200;

/// Cumulates the areas, finds the nearest source of every cell and draws the places of each region.
///
/// @param sources  at least one, on the grid
/// @param region   on the grid of the terrain; its largest value is the number of regions
MappedDeposits mapped_deposits(std::vector<DepositSource> sources, Raster<std::uint8_t> region);

/// The region of a place; 0 where nothing was mapped and off the grid.
std::uint8_t region_at(const MappedDeposits& deposits, const Eigen::Vector2d& place);

/// The source at a share of the area, 0..1.
const DepositSource& source_at(const MappedDeposits& deposits, double share);

/// How far a place of rest is from where blocks may have come.
struct RunOut {
  double distance = kNotGiven;  ///< in plan, to the centre of the nearest source [m]
  double angle = kNotGiven;     ///< below the horizontal of the line from there to the place [rad]; NaN in the source
};

/// The run-out of a place: of the source that is nearest in plan to the centre of its cell. NaN off the terrain. The
/// angle of a place within one cell of the source's centre is NaN: there it is that of the cells.
RunOut run_out(const Campaign& campaign, const Eigen::Vector2d& place);

/// Limits between at most three classes of size with at least 20 diameters each [m], as alike in number as ties allow.
/// Diameters are compared as by `class_of`.
std::vector<double> class_limits(std::vector<double> diameters);

/// Class of a diameter [m]: the number of limits at or below it. Both are compared in whole nanometres, because a
/// diameter that was written in a table is a mass meanwhile, and comes back with another last bit.
std::size_t class_of(const MappedDeposits& deposits, double diameter);
/// "deposits", or with several classes "deposits below 0.5 m", "deposits 0.5 to 1 m", "deposits from 1 m".
std::string class_name(const MappedDeposits& deposits, std::size_t number);

/// Strips across the slope, which are parallel to the line from the middle of the sources to that of the blocks. Each
/// has the same number of blocks.
struct Strips {
  Eigen::Vector2d across = Eigen::Vector2d::UnitX();  ///< unit vector to the left of the line
  std::vector<double> limits;                         ///< between the strips, along `across` [m]

  /// Number of the strip of a place, from 0.
  std::size_t of(const Eigen::Vector2d& place) const;
};
Strips strips_of(const MappedDeposits& deposits, std::span<const Eigen::Vector2d> blocks, std::size_t count);

}  // namespace talus
