#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "talus/base/scratch.hpp"

namespace talus::run {

/// Limit of memory [byte] from the text of --memory, such as "2G" or "500M". An empty text gives 0: no limit. Throws
/// InputError if the text is no size, or if the limit is too small for `threads` threads to trace or to write maps.
std::size_t memory_limit_of(const std::string& text, int threads);

/// Makes the file that holds terrain, zones and tally beside the results (or in the nearest folder above them that is
/// there), with at most `bytes` of memory for the process. Sets GDAL's cache to a sixteenth of `bytes`. Call it before
/// anything is read. Throws InputError if nothing can be written there; std::runtime_error if the file cannot be made.
///
/// @return null if `bytes` is 0
std::unique_ptr<ScratchFile> scratch_file_beside(const std::filesystem::path& results, std::size_t bytes);

}  // namespace talus::run
