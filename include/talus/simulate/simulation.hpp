#pragma once
#include "talus/simulate/plan/part.hpp"
#include "talus/simulate/plan/process_group.hpp"
#include "talus/simulate/reaches.hpp"
#include "talus/simulate/sinks.hpp"
#include "talus/simulate/tally/tally.hpp"
#include "talus/simulate/totals.hpp"

namespace talus {

/// A run that can be paused, kept on the disk and gone on with: same bits wherever it pauses.
///
/// A round traces `scenario.trajectories` blocks of each source cell: round r the blocks from r times that number on.
/// Work is done in units, blocks of one source cell, in the order of `work_order`; a pause comes between units, and all
/// before it are done, by whichever process of the process group.
class Simulation {
 public:
  struct Position {
    std::uint32_t round = 0;  ///< the current one, from 0
    std::uint64_t unit = 0;   ///< the first of it that is not done
  };

  /// @param further_rounds  there may be more than one
  /// The scenario, the tally, the sinks and the process group must outlive it.
  Simulation(const Scenario& scenario, const Part& part, bool further_rounds, Tally& tally, const Sinks& sinks,
             ProcessGroup& processes = alone());

  /// Traces on to the end of the round, or until `sinks.pause` or `sinks.progress` of one process asks to stop.
  /// All processes of the process group must call it. Tally, totals and rows are then of what this process has traced.
  ///
  /// @param threads  0: as many as the machine has
  /// An exception of a sink leaves it of no use.
  void advance(int threads);

  bool round_done() const { return position_.unit == units_; }
  void next_round() { position_ = {position_.round + 1, 0}; }

  const Position& position() const { return position_; }
  const Totals& totals() const { return totals_; }
  void save_reaches(const std::function<void(std::string_view)>& put) const;

  /// Goes on from what was kept; before the first `advance`. Then what `save_reaches` of each process that kept it has
  /// handed out, piece by piece.
  void restore(const Position& position, const Totals& totals);
  void restore_reach(ByteReader& piece);

 private:
  class Advance;
  const Scenario& scenario_;
  Tally& tally_;
  const Sinks& sinks_;
  ProcessGroup& processes_;
  ScreenFinder screens_;
  std::vector<std::uint32_t> order_;  // numbers of all source cells
  std::uint32_t first_place_, units_per_source_;
  std::uint64_t units_, chunk_;  // of this part; that one process takes at a time
  bool further_rounds_;
  Position position_;
  Totals totals_;
  Reaches reaches_;
};

}  // namespace talus
