#pragma once

namespace talus {

/// Asks the C library to take memory from the system in large steps and to keep what is freed: for programs that
/// allocate the records of many cells one by one. For `main`, before anything else; changes no result.
void keep_freed_memory();

}  // namespace talus
