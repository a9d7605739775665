#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace talus::io {

/// What a table says of the blocks that crossed one screen. Each list has the rows that hold its quantity.
struct CrossingTable {
  std::vector<double> speed;            ///< [m/s]
  std::vector<double> energy;           ///< translational [J]
  std::vector<double> height;           ///< vertical, ground to centre [m]
  std::vector<double> mass;             ///< [kg]
  std::vector<Eigen::Vector2d> places;  ///< in map coordinates [m]
  std::size_t blocks = 0;
};

/// Reads crossings: `screens.csv` of a run, `passages.csv` of a campaign, or a table of one's own with columns of
/// these.
///
/// @param screen  rows of other screens are left out
///
/// Columns: screen, and of id, source, block, speed_ms, energy_kj, jump_height_m, mass_kg, x, y those that are there
/// (others of the two tables are allowed and not read). Energy is energy_kj, else 1/2 mass speed^2 where both are
/// there. Of the rows of one block (same id, source, block and mass) the first counts: a block that rolls back would be
/// met by a barrier once. Throws InputError with line and column; a screen without rows gives empty lists.
CrossingTable read_crossings(const std::string& path, const std::string& screen);

}  // namespace talus::io
