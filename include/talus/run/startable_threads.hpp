#pragma once

namespace talus::run {

/// Starts threads for the parallel loops and keeps them, if all can be started. Under a limit of memory or of processes
/// OpenMP would end the program without an error of ours.
///
/// @return `threads`, or how many of them can be started, this one included
int startable_threads(int threads);

}  // namespace talus::run
