#pragma once
#include "talus/simulate/stop_row.hpp"

namespace talus {

/// Whether a block came to rest within two of its diameters, in plan, of where it was released: stopped or trapped.
bool held_at_release(const StopRow& row);

}  // namespace talus
