#include "talus/io/gdal/layer_name.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "csv_table.hpp"
#include "talus/base/shell.hpp"

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

/// A whole number from 0; -1: the text is none.
int number_of_layer(std::string_view text) {
  int number = -1;
  const char* const last = text.data() + text.size();
  const auto [end, fault] = std::from_chars(text.data(), last, number);
  return fault == std::errc() && end == last ? std::max(number, -1) : -1;
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
    const bool first = found.layer.empty() && found.number < 0;
    if (key == "layername") found.layer = value;
    if (key == "layerid") found.number = number_of_layer(value);
    const bool read = key == "layername" ? !value.empty() : key == "layerid" && found.number >= 0;
    if (!read || !first) found.unread = "|" + part;
    at = end;
  }
  return found;
}

std::string spelling_of_layer(const std::string& name) {
  for (std::size_t at = name.find('|'); at != std::string::npos; at = name.find('|', at + 1)) {
    std::error_code none;
    const std::string file = name.substr(0, at), rest = name.substr(at + 1);
    if (!std::filesystem::is_regular_file(file, none)) continue;
    const std::string layer = trimmed(rest.substr(rest.find('=') + 1));  // all of it without a "="
    return "; its layer is named by " + shell_word(file + "|layername=" + (layer.empty() ? "NAME" : layer));
  }
  return {};
}

}  // namespace talus::io
