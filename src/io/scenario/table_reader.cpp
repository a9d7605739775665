#include "table_reader.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {

namespace {
using Kind = TomlValue::Kind;
}

const TomlValue* TableReader::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_ == nullptr ? nullptr : table_->find(key);
}

TableReader TableReader::table(const std::string& key) {
  const TomlValue* value = find(key);
  if (value != nullptr && value->kind != Kind::Table) {
    fault(key, *value, "must be a table, [" + full(key) + "]");
    value = nullptr;
  }
  return {value, full(key), file_, faults_};
}

std::optional<double> TableReader::checked(const std::string& key, const TomlValue& value, const Bounds& bounds) {
  if (value.kind != Kind::Number) {
    fault(key, value,
          std::string("must be a ") + (bounds.whole ? "whole number" : "number") +
              (bounds.unit == "1" ? "" : " in " + std::string(bounds.unit)));
    return std::nullopt;
  }
  if (const auto rule = fault_of(bounds, value.number)) {
    fault(key, value, *rule);
    return std::nullopt;
  }
  return value.number;
}

std::optional<double> TableReader::number(const std::string& key, const Bounds& bounds) {
  const TomlValue* value = find(key);
  return value == nullptr ? std::nullopt : checked(key, *value, bounds);
}

std::optional<std::string> TableReader::text(const std::string& key) {
  const TomlValue* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->kind == Kind::Text && !value->text.empty()) return value->text;
  fault(key, *value, "must be text in quotation marks, not empty");
  return std::nullopt;
}

std::optional<NamedFile> TableReader::named_file(const std::string& key, const std::filesystem::path& base) {
  const auto name = text(key);
  if (!name) return std::nullopt;
  return NamedFile{absolute_path(*name, base), where(key, *table_->find(key))};
}

std::optional<Range> TableReader::range(const std::string& key, const Bounds& bounds) {
  const TomlValue* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->kind == Kind::Number) {
    const auto number = checked(key, *value, bounds);
    return number ? std::optional(Range{*number, *number}) : std::nullopt;
  }
  if (value->kind != Kind::List || value->items.size() != 2) {
    fault(key, *value,
          "must be a number or [smallest, largest]" +
              (bounds.unit == "1" ? std::string() : " in " + std::string(bounds.unit)));
    return std::nullopt;
  }
  const auto low = checked(key, value->items[0], bounds), high = checked(key, value->items[1], bounds);
  if (!low || !high) return std::nullopt;
  if (*low <= *high) return Range{*low, *high};
  fault(key, *value, "must be [smallest, largest]");
  return std::nullopt;
}

std::optional<std::vector<double>> TableReader::numbers(const std::string& key, const Bounds& bounds) {
  const TomlValue* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->kind != Kind::List) {
    fault(key, *value, "must be a list of numbers, like [1, 2]");
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const TomlValue& item : value->items)
    if (const auto number = checked(key, item, bounds)) numbers.push_back(*number);
  return numbers.size() == value->items.size() ? std::optional(numbers) : std::nullopt;
}

std::string TableReader::at(const TomlValue& value) const {
  return file_ + (value.line > 0 ? ":" + std::to_string(value.line) : "");
}

std::string TableReader::where(const std::string& key, const TomlValue& value) const {
  return at(value) + ": " + full(key) + " = " + value.shown();
}

void TableReader::fault(const std::string& key, const TomlValue& value, const std::string& rule) {
  faults_.push_back(where(key, value) + ": " + rule);
}

void TableReader::finish() {
  if (table_ == nullptr) return;
  for (const auto& [key, value] : table_->members)
    if (std::find(known_.begin(), known_.end(), key) == known_.end())
      faults_.push_back(at(value) + ": unknown key '" + key + "' " +
                        (name_.empty() ? "at the top" : "in [" + name_ + "]") + known_names(key, known_));
}

}  // namespace talus::io
