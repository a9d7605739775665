#pragma once
#include <string>
#include <vector>

namespace talus::io {

struct TomlMember;

/// A value of a TOML file with its line (0: from a flag). Other files use this instead of toml++, which is slow to
/// compile.
struct TomlValue {
  enum class Kind { Boolean, Number, Text, List, Table, Date };

  Kind kind = Kind::Table;
  int line = 0;  ///< from 1
  bool boolean = false;
  double number = 0.0;  ///< whole numbers too; beyond 2^53 rounded
  std::string text;
  std::vector<TomlValue> items;     ///< of a list
  std::vector<TomlMember> members;  ///< of a table, in the order of the file

  const TomlValue* find(const std::string& key) const;
  /// Whether a file says nothing: it has no key, or only tables without one.
  bool says_nothing() const;
  /// The value in short, for messages: "'abc'", "3.5", "a table".
  std::string shown() const;
};

struct TomlMember {
  std::string key;
  TomlValue value;
};

/// Reads a TOML file. `name` stands for it in messages.
/// Throws InputError "name:12: ..." where it cannot be read or is no TOML.
TomlValue read_toml(const std::string& path, const std::string& name);

/// The value that a text is in TOML, as after "KEY = ": 0.7, ["talus"]. What is no TOML is a text: measured.
TomlValue toml_value(const std::string& text);

/// Reads a TOML file that is given for its settings. Throws also if it has no key: the defaults would be taken
/// unnoticed.
///
/// @param content  settings that it should have, for the message: "name: holds no [model] or [effects]"
TomlValue read_settings(const std::string& path, const std::string& name, const std::string& content);

}  // namespace talus::io
