#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "talus/base/scratch.hpp"

namespace talus::run {

/// The limit that --memory says, such as "2G" or "500M", in bytes; 0 where the text is empty: no limit. Throws
/// InputError where it is none, or less than what so many threads need to trace, or to write maps.
std::size_t memory_limit_of(const std::string& text, int threads);

/// The file beside the results in which lies what grows with the map and does not fit into so many bytes; GDAL's cache
/// gets a sixteenth of them. To be made before anything is read. Throws InputError where there is no folder for the
/// results to go into.
///
/// @return null where `bytes` is 0
std::unique_ptr<ScratchFile> scratch_file_beside(const std::filesystem::path& results, std::size_t bytes);

}  // namespace talus::run
