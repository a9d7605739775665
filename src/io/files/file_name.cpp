#include "talus/io/files/file_name.hpp"

#include <algorithm>

#include "io/files/checksum.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kLongest = 120;  // [byte]: file systems take 255, with what is added

std::string plain(const std::string& id) {
  std::string name = id;
  for (char& c : name) {
    const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                       c == '_' || static_cast<unsigned char>(c) >= 0x80;
    if (!stays) c = '_';
  }
  return name;
}

/// Whether a file system may take two names for one.
bool alike(const std::string& a, const std::string& b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, small, small);
}

/// The first bytes of a name, without half a character at the end.
std::string first_bytes(const std::string& name) {
  std::size_t end = std::min(name.size(), kLongest);
  const auto continues = [&](std::size_t i) { return (static_cast<unsigned char>(name[i]) & 0xC0U) == 0x80U; };
  while (end > 0 && end < name.size() && continues(end)) --end;
  return name.substr(0, end);
}

std::string name_among(const std::string& id, std::span<const std::string> ids) {
  const std::string name = plain(id);
  const bool unique =
      std::ranges::none_of(ids, [&](const std::string& other) { return other != id && alike(plain(other), name); });
  return unique && name.size() <= kLongest ? name : first_bytes(name) + "-" + sha256_of_bytes(id).substr(0, 8);
}

}  // namespace

std::string file_name_of(const std::string& id, std::span<const std::string> ids) {
  std::string name = name_among(id, ids);
  for (const std::string& other : ids)
    if (other != id && alike(name_among(other, ids), name))
      throw InputError("the ids '" + id + "' and '" + other + "' would give files of one name, '" + name +
                       "'; give one of them another id");
  return name;
}

}  // namespace talus::io
