#include "cause_of_failure.hpp"

#include <cstdint>

namespace talus::io {

namespace fs = std::filesystem;

std::string cause_of_failure(const fs::path& folder, const std::string& messages) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (!error && space.available < (std::uintmax_t{1} << 20U)) return "the disk is full";
  return messages.substr(0, messages.find("; "));
}

}  // namespace talus::io
