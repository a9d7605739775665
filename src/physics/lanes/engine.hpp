#pragma once

namespace talus {

class Pool;

/// Follows the blocks of a pool to their ends. Only where the processor has these instructions.
void follow_in_4_lanes(Pool& pool);
void follow_in_8_lanes(Pool& pool);

}  // namespace talus
