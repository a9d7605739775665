#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/stop_row.hpp"

namespace talus {

/// Counts the blocks that stay (stopped or trapped) in gullies that are too steep to rest in: `in_steep_gully`. The
/// counts do not depend on the order of the rows.
class GullyStops {
 public:
  /// A cell and the blocks that stay in it.
  struct Cell {
    int column, row;
    std::uint64_t blocks;
  };

  /// The scenario must outlive it.
  explicit GullyStops(const Scenario& scenario) : scenario_(scenario) {}

  void add(std::span<const StopRow> rows);
  std::uint64_t blocks() const;
  /// The cell in which most blocks stay, of equal ones the southernmost, then the westernmost; nothing if none stay.
  std::optional<Cell> worst() const;

 private:
  const Scenario& scenario_;
  std::unordered_map<std::size_t, std::uint64_t> by_cell_;  // only cells in which some block stays
};

}  // namespace talus
