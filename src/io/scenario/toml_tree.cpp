#include "toml_tree.hpp"

#include <toml++/toml.h>

#include <algorithm>

#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace {

constexpr int kDeepest = 16;              // tables, lists and parts of a dotted key in one another
constexpr std::size_t kLongestKey = 200;  // [byte]

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

[[noreturn]] void refuse_depth(const std::string& name, int line) {
  throw InputError(name + ":" + std::to_string(line) + ": tables and lists in one another, more than " +
                   std::to_string(kDeepest) + " deep: no key of Talus lies so deep");
}

/// The places of a TOML text that are no string and no comment, one by one.
class Bare {
 public:
  explicit Bare(std::string_view text) : text_(text) {}

  /// The next character outside of strings and comments; 0 at the end.
  char next() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'')
        skip_string(c);
      else if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        return ++at_, line_ += c == '\n' ? 1 : 0, c;
    }
    return '\0';
  }
  int line() const { return line_; }

 private:
  void skip_string(char quote) {
    const bool block = text_.substr(at_, 3) == std::string(3, quote);
    at_ += block ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n' && !block) return;  // not closed: the parser says so
      line_ += c == '\n' ? 1 : 0;
      if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == quote && (!block || text_.substr(at_, 3) == std::string(3, quote))) {
        at_ += block ? 3 : 1;
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Throws InputError for tables, lists and dotted keys so deep in one another that the parser, which calls itself,
/// would run out of memory for its calls.
void check_depth(std::string_view text, const std::string& name) {
  Bare bare(text);
  int brackets = 0, dots = 0;
  for (char c = bare.next(); c != '\0'; c = bare.next()) {
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (c == '.') ++dots;
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots = 0;
    if (brackets > kDeepest || dots > kDeepest) refuse_depth(name, bare.line());
  }
}

/// Throws InputError for keys that are too long and texts that no file name and no message can hold.
void check_texts(const TomlValue& value, const std::string& name) {
  if (value.text.find('\0') != std::string::npos)
    throw InputError(name + ":" + std::to_string(value.line) + ": a text has the character of number 0 (\\u0000) in " +
                     "it, must have none");
  for (const auto& [key, member] : value.members) {
    if (key.size() > kLongestKey)
      throw InputError(name + ":" + std::to_string(member.line) + ": key '" + shortened(key, 40) + "' has " +
                       std::to_string(key.size()) + " letters, must have at most " + std::to_string(kLongestKey));
    check_texts(member, name);
  }
  for (const TomlValue& item : value.items) check_texts(item, name);
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  for (const auto& [name, value] : members)
    if (name == key) return &value;
  return nullptr;
}

bool TomlValue::says_nothing() const {
  return std::ranges::all_of(members, [](const TomlMember& member) {
    return member.value.kind == Kind::Table && member.value.members.empty();
  });
}

std::string TomlValue::shown() const {
  switch (kind) {
    case Kind::Boolean:
      return boolean ? "true" : "false";
    case Kind::Number:
      return text_of(number);
    case Kind::Text:
      return "'" + shortened(text, 200) + "'";
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
  const std::string text = read_file(path, name, "a TOML file", kMostToml);
  check_depth(text, name);
  try {
    TomlValue tree = converted(toml::parse(text));
    check_texts(tree, name);
    return tree;
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(name + ":" + std::to_string(error.source().begin.line) + ": is no valid TOML: " + what);
  }
}

TomlValue toml_value(const std::string& text) {
  check_depth(text, text);
  TomlValue value;
  value.kind = TomlValue::Kind::Text;
  value.text = text;
  try {
    const TomlValue tree = converted(toml::parse("value = " + text));
    if (tree.members.size() == 1) value = tree.members.front().value;
  } catch (const toml::parse_error&) {  // a text without quotation marks
  }
  value.line = 0;
  return value;
}

TomlValue read_settings(const std::string& path, const std::string& name, const std::string& content) {
  TomlValue tree = read_toml(path, name);
  if (tree.says_nothing()) throw InputError(name + ": holds no " + content + ": is it the file that was meant?");
  return tree;
}

}  // namespace talus::io
