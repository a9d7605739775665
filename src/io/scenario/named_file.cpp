#include "named_file.hpp"

#include <cpl_string.h>

#include "io/gdal/dataset.hpp"
#include "io/gdal/input_name.hpp"
#include "talus/io/gdal/layer_name.hpp"

namespace talus::io {

namespace {

/// The name of a file in an archive with the absolute path of the archive; any other name of GDAL's as it is.
std::string in_archive(const std::string& name, const std::filesystem::path& base) {
  const std::size_t at = archive_in(name);
  if (at == std::string::npos) return name;
  return name.substr(0, at) + std::filesystem::absolute(base / name.substr(at)).lexically_normal().string();
}

}  // namespace

std::string absolute_path(const std::string& given, const std::filesystem::path& base) {
  std::error_code none;
  const std::string file = file_of_layer(given);
  if (file.starts_with("/vsi")) return same_layer_in(in_archive(file, base), given);
  const std::filesystem::path path = (base / file).lexically_normal();
  if (file.find(':') != std::string::npos && !std::filesystem::exists(path, none)) {
    const auto part = part_name(file, base);
    if (!part || part->file.empty()) return given;
    return same_layer_in(part->before + absolute_path(part->file, base) + part->after, given);
  }
  return same_layer_in(std::filesystem::absolute(path).lexically_normal().string(), given);
}

std::string fault_of_encoding(const std::string& name, const std::string& what, const std::string& way_out) {
  if (CPLIsUTF8(name.c_str(), static_cast<int>(name.size())) != 0) return {};
  return what + " is not UTF-8, which the scenario of a run cannot hold (" + name + "): " + way_out;
}

void check_encoding(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults) {
  for (const NamedFile* file : files)
    if (const std::string fault = fault_of_encoding(file->path); !fault.empty())
      faults.push_back(file->where + ": " + fault);
}

namespace {

/// Where the scenario is that of results or of a part: the way out if its inputs are elsewhere by now.
std::string moved_hint(const std::string& where) {
  const std::size_t name = where.find("scenario.toml:");
  if (name == std::string::npos) return {};
  const std::filesystem::path folder = where.substr(0, name);
  const bool recorded = std::filesystem::exists(folder / "run.json") || std::filesystem::exists(folder / "part.json");
  return recorded ? "; if the inputs have moved, correct their paths in this file: what they hold is compared" : "";
}

}  // namespace

void check_files(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults) {
  start_gdal();
  for (const NamedFile* file : files) {
    if (file->path.empty()) continue;
    const std::string path = file_of_layer(file->path);
    const InputName name = looked_up(path);
    VSIStatBufL status;
    if (!name.fault.empty())
      faults.push_back(file->where + ": " + name.fault);
    else if (name.network ? VSIStatL(name_for_gdal(path).c_str(), &status) != 0 : name.file.empty())
      faults.push_back(file->where + ": no such file (" + path + ")" + spelling_of_layer(path) +
                       moved_hint(file->where));
  }
}

}  // namespace talus::io
