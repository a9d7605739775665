#pragma once
#include <filesystem>
#include <string>

namespace talus::io {

/// Cause why a library could not write into a folder: "the disk is full" if it is, else the first of `messages`.
std::string cause_of_failure(const std::filesystem::path& folder, const std::string& messages);

}  // namespace talus::io
