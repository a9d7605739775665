#include "talus/base/hidden_name.hpp"

#include <algorithm>

namespace talus {
namespace {

constexpr std::string_view kMark = ".talus-";

}  // namespace

std::string hidden_prefix(std::string_view stem) {
  return "." + std::string(stem) + std::string(kMark);
}

std::string final_name(std::string_view name) {
  const std::size_t mark = name.rfind(kMark);
  if (!name.starts_with('.') || mark == std::string_view::npos || mark == 0) return std::string(name);
  const std::size_t end = std::min(name.size(), name.find_first_not_of("0123456789-", mark + kMark.size()));
  return std::string(name.substr(1, mark - 1)) + std::string(name.substr(end));
}

}  // namespace talus
