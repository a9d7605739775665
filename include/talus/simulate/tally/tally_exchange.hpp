#pragma once
#include "talus/simulate/plan/process_group.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// Each process of a process group has a tally of what it has traced. These bring them together; all must call them.
/// The sums are of whole numbers: same bits in any order.

/// Afterwards each region of the tally lies with one process, which owns it, and holds what all have counted there.
void share_out(Tally& tally, ProcessGroup& processes);

/// Afterwards the leader has all; the others have nothing.
void collect(Tally& tally, ProcessGroup& processes);

}  // namespace talus
