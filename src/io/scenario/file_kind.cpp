#include "file_kind.hpp"

#include <algorithm>
#include <optional>

#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"

namespace talus::io {
namespace {

using Kind = TomlValue::Kind;

/// The kind of file that alone has such a key in its top table.
std::optional<FileKind> kind_with(const TomlMember& member) {
  const auto& [key, value] = member;
  const bool text = value.kind == Kind::Text, table = value.kind == Kind::Table;
  if (text && (key == "profile" || key == "line")) return FileKind::Profile;
  if (text && (key == "stops" || key == "passages")) return FileKind::Campaign;
  if (table && (key == "deposits" || key == "zone_names" || key == "measurement_error")) return FileKind::Campaign;
  if (table && key == "sources" && value.find("file") != nullptr) return FileKind::Scenario;
  return {};
}

std::string name_of(FileKind kind) {
  switch (kind) {
    case FileKind::Scenario:
      return "a scenario of talus run";
    case FileKind::Profile:
      return "a file of talus profile";
    case FileKind::Campaign:
      break;
  }
  return "a campaign of talus calibrate, diagnose and score";
}

/// What takes a file of this kind.
std::string way_out(FileKind kind, const std::string& file) {
  const std::string rest = " " + shell_word(file) + " -o FOLDER ";
  switch (kind) {
    case FileKind::Scenario:
      return "talus run" + rest + "simulates it";
    case FileKind::Profile:
      return "talus profile" + rest + "simulates it";
    case FileKind::Campaign:
      break;
  }
  return "talus calibrate" + rest + "fits the ground to it";
}

}  // namespace

void refuse_other_kind(const TomlValue& root, const std::string& file, FileKind expected) {
  const auto shows = [&](const TomlMember& member) { return kind_with(member).value_or(expected) != expected; };
  const auto of_expected = [&](const TomlMember& member) { return kind_with(member) == expected; };
  const auto found = std::ranges::find_if(root.members, shows);
  if (found == root.members.end() || std::ranges::any_of(root.members, of_expected)) return;
  const auto& [key, value] = *found;
  const FileKind kind = *kind_with(*found);
  throw InputError(file + ":" + std::to_string(value.line) + ": " +
                   (value.kind == Kind::Table ? "[" + key + "]" : key + " = " + value.shown()) + ": this is " +
                   name_of(kind) + ", must be " + name_of(expected) + ": " + way_out(kind, file));
}

}  // namespace talus::io
