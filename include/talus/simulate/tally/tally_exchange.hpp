#pragma once
#include "talus/simulate/plan/process_group.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

// Each process of a process group has a tally of the trajectories that it traced. These functions join the tallies; all
// processes must call them. The sums are of whole numbers: same bits in any order.

/// Sends each region to the process that owns it. Afterwards this process has the sums of all processes there.
void share_out(Tally& tally, ProcessGroup& processes);

/// Sends everything to the leader. Afterwards the other tallies are empty.
void collect(Tally& tally, ProcessGroup& processes);

}  // namespace talus
