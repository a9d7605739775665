#pragma once
#include "talus/simulate/plan/part.hpp"
#include "talus/simulate/plan/process_group.hpp"
#include "talus/simulate/reaches.hpp"
#include "talus/simulate/sinks.hpp"
#include "talus/simulate/tally/tally.hpp"
#include "talus/simulate/totals.hpp"

namespace talus {

/// A run that can be paused, saved and continued. The bits do not depend on where it pauses.
///
/// A round traces `scenario.trajectories` blocks of each source cell; round r begins with block r times that number.
/// A unit of work is some blocks of one source cell. Source cells follow each other as in `work_order`. A pause comes
/// between units: all units before it are done, by whichever process of the process group.
class Simulation {
 public:
  struct Position {
    std::uint32_t round = 0;  ///< current round, from 0
    std::uint64_t unit = 0;   ///< first unit of the round that is not done
  };

  /// @param further_rounds  there may be more rounds than one
  /// The scenario, the tally, the sinks and the process group must outlive it.
  Simulation(const Scenario& scenario, const Part& part, bool further_rounds, Tally& tally, const Sinks& sinks,
             ProcessGroup& processes = alone());

  /// Traces to the end of the round, or until `sinks.pause` or `sinks.progress` of one process asks to stop.
  /// All processes of the process group must call it. Tally, totals and rows then cover what this process has traced.
  ///
  /// @param threads  0: as many as the machine has
  /// @param lanes    trajectories in one instruction, as for Tracer; 0: as many as the processor has
  /// After an exception of a sink the simulation must not be used any more.
  void advance(int threads, int lanes = 0);

  bool round_done() const { return position_.unit == unit_count_; }
  void next_round() { position_ = {position_.round + 1, 0}; }

  const Position& position() const { return position_; }
  const Totals& totals() const { return totals_; }
  void save_reaches(const std::function<void(std::string_view)>& put) const;

  /// Continues from a saved position; call it before the first `advance`. Then pass to `restore_reach` every piece that
  /// `save_reaches` handed out, in any process that saved.
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
  std::uint64_t unit_count_, chunk_;  // units of this part; units of one chunk
  bool further_rounds_;
  Position position_;
  Totals totals_;
  Reaches reaches_;
};

}  // namespace talus
