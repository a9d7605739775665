#include "toml_tree.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace {

TomlValue converted(const toml::node& node);

void convert_table(const toml::table& table, TomlValue& value) {
  value.kind = TomlValue::Kind::Table;
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return a.first->source().begin < b.first->source().begin; });
  for (const auto& [key, node] : entries) {
    TomlValue member = converted(*node);
    member.line = static_cast<int>(key->source().begin.line);  // of the first header, if a table has several
    value.members.push_back({std::string(key->str()), std::move(member)});
  }
}

TomlValue converted(const toml::node& node) {
  TomlValue value;
  value.line = static_cast<int>(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    convert_table(*table, value);
  } else if (const auto* list = node.as_array()) {
    value.kind = TomlValue::Kind::List;
    for (const toml::node& item : *list) value.items.push_back(converted(item));
  } else if (const auto* text = node.as_string()) {
    value.kind = TomlValue::Kind::Text;
    value.text = text->get();
  } else if (const auto* boolean = node.as_boolean()) {
    value.kind = TomlValue::Kind::Boolean;
    value.boolean = boolean->get();
  } else if (node.is_number()) {
    value.kind = TomlValue::Kind::Number;
    value.number = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  } else {
    value.kind = TomlValue::Kind::Date;
  }
  return value;
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  for (const auto& [name, value] : members)
    if (name == key) return &value;
  return nullptr;
}

std::string TomlValue::shown() const {
  switch (kind) {
    case Kind::Boolean:
      return boolean ? "true" : "false";
    case Kind::Number:
      return text_of(number);
    case Kind::Text:
      return "'" + text + "'";
    case Kind::List: {
      std::vector<std::string> shown;
      for (std::size_t i = 0; i < items.size() && i < 6; ++i) shown.push_back(items[i].shown());
      if (items.size() > 6) shown.emplace_back("...");
      return std::string("[") + joined(shown) + "]";
    }
    case Kind::Table:
      return "a table";
    default:
      return "a date or time";
  }
}

TomlValue read_toml(const std::string& path, const std::string& name) {
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open() || std::filesystem::is_directory(path, none))
    throw InputError(name + ": cannot be read, must be a TOML file");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  try {
    return converted(toml::parse(text));
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(name + ":" + std::to_string(error.source().begin.line) + ": is no valid TOML: " + what);
  }
}

}  // namespace talus::io
