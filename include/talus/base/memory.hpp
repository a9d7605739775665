#pragma once

namespace talus {

/// Asks the C library to take memory from the system in large steps and to keep freed memory for later use: for
/// programs that allocate the records of many cells one by one. Call it first in `main`; it changes no result.
void keep_freed_memory();

}  // namespace talus
