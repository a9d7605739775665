#pragma once
#include <optional>
#include <string>
#include <vector>

#include "named_file.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "toml_tree.hpp"

namespace talus::io {

/// Reads one table of a scenario file key by key; faults are collected, each as one line with file, line, key, value
/// and what is allowed.
class TableReader {
 public:
  /// @param name  "blocks"; empty for the file itself
  /// @param table may be null: then no key is there
  TableReader(const TomlValue* table, std::string name, std::string file, std::vector<std::string>& faults)
      : table_(table), name_(std::move(name)), file_(std::move(file)), faults_(faults) {}

  /// The value of a key; null if it is not there. Marks the key as known.
  const TomlValue* find(const std::string& key);
  /// A table inside this one.
  TableReader table(const std::string& key);

  std::optional<double> number(const std::string& key, const Bounds& bounds);
  std::optional<std::string> text(const std::string& key);
  /// @param base  folder to which the name is relative
  std::optional<NamedFile> named_file(const std::string& key, const std::filesystem::path& base);
  /// A number, or [smallest, largest].
  std::optional<Range> range(const std::string& key, const Bounds& bounds);
  std::optional<std::vector<double>> numbers(const std::string& key, const Bounds& bounds);

  /// Adds a fault: "scenario.toml:12: blocks.density = 9: `rule`".
  void fault(const std::string& key, const TomlValue& value, const std::string& rule);
  /// "scenario.toml:3"; without the line where there is none.
  std::string at(const TomlValue& value) const;
  /// "scenario.toml:3: dem = 'dem.tif'".
  std::string where(const std::string& key, const TomlValue& value) const;
  /// "blocks.density".
  std::string full(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }

  const TomlValue* value() const { return table_; }
  const std::string& file() const { return file_; }
  std::vector<std::string>& faults() { return faults_; }

  /// Adds a fault for each key that was not asked for.
  void finish();

 private:
  std::optional<double> checked(const std::string& key, const TomlValue& value, const Bounds& bounds);

  const TomlValue* table_;
  std::string name_, file_;
  std::vector<std::string>& faults_;
  std::vector<std::string> known_;
};

}  // namespace talus::io
