#include "talus/io/gdal/layer_name.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace talus::io {
namespace {

constexpr std::array<std::string_view, 4> kKeys{"layername=", "layerid=", "subset=", "geometrytype="};

bool is_key(std::string_view text) {
  return std::ranges::any_of(kKeys, [&](std::string_view key) { return text.starts_with(key); });
}

/// Where the next "|" stands that begins a part of QGIS; npos: there is none. A file may have others in its name.
std::size_t next_part(std::string_view name, std::size_t from) {
  for (std::size_t at = name.find('|', from); at != std::string_view::npos; at = name.find('|', at + 1))
    if (is_key(name.substr(at + 1))) return at;
  return std::string_view::npos;
}

}  // namespace

NamedLayer named_layer(const std::string& name) {
  std::size_t at = next_part(name, 0);
  NamedLayer found{name.substr(0, at), {}, -1, {}};
  while (at != std::string::npos) {
    const std::size_t end = next_part(name, at + 1);
    const std::string part = name.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals), value = part.substr(equals + 1);
    if (key == "layername") found.layer = value;
    const char* const last = value.data() + value.size();
    const bool number =
        key == "layerid" && std::from_chars(value.data(), last, found.number).ptr == last && !value.empty();
    if (key != "layername" && !number) found.unread = "|" + part;
    at = end;
  }
  return found;
}

}  // namespace talus::io
