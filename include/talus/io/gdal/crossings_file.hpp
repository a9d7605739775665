#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace talus::io {

/// The first crossings of one screen by blocks and pieces, from a table. Each list has the rows that give its quantity.
struct CrossingTable {
  /// A further crossing of the screen by a block or piece; NaN: not given.
  struct Again {
    std::size_t first;  ///< number of its first crossing
    double speed, height, mass;
    Eigen::Vector2d place;
  };
  std::vector<double> speed;               ///< [m/s]
  std::vector<double> energy;              ///< translational [J]
  std::vector<double> height;              ///< of the block's lowest point, vertical [m]
  std::vector<double> mass;                ///< [kg]
  std::vector<Eigen::Vector2d> places;     ///< in map coordinates [m]
  std::vector<std::string> source, block;  ///< as the table names them, one for each crossing
  std::vector<std::size_t> number;  ///< of the block, from 0, one for each crossing: pieces have that of their block
  std::vector<Again> again;         ///< in the order of the table
  std::size_t count = 0;            ///< of blocks and pieces
  std::size_t blocks = 0;           ///< blocks of which something crossed
  std::size_t rows = 0;             ///< of the screen: with those of blocks and pieces that cross again
  std::map<std::string, std::size_t> others;  ///< rows of every other screen
};

/// Reads crossings: `screens.csv` of a run, `passages.csv` of a campaign, or any table with columns of these.
///
/// @param screen  rows of other screens are left out
///
/// Columns: screen must be there; id, source, block, piece, speed_ms, energy_kj, jump_height_m, mass_kg, x, y are read
/// if they are there. Other columns of the two tables are ignored. Energy is energy_kj, else 1/2 mass speed^2 if both
/// are there. Only the first row of a block or piece counts: one that rolls back meets a barrier only once; the others
/// are in `again`. It is known by id, source, block and piece; by its mass where no piece is given. Throws InputError
/// with line and column; a screen without rows gives empty lists.
CrossingTable read_crossings(const std::string& path, const std::string& screen);

/// How many crossings of a screen `screens_summary.csv` tells; nothing if it is not there. Throws InputError
/// if it does not know the screen.
std::optional<std::size_t> crossings_in_summary(const std::string& path, const std::string& screen);

}  // namespace talus::io
