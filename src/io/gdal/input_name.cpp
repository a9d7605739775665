#include "input_name.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "vrt_check.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 3> kArchives{"/vsizip/", "/vsitar/", "/vsigzip/"};
constexpr std::array<std::string_view, 8> kNetworks{"/vsicurl", "/vsis3",  "/vsigs",    "/vsiaz",
                                                    "/vsiadls", "/vsioss", "/vsiswift", "/vsiwebhdfs"};
constexpr std::array<std::string_view, 3> kWeb{"http://", "https://", "ftp://"};
/// Names of a part of a file: "NETCDF:file.nc:height".
constexpr std::array<std::string_view, 3> kParts{"NETCDF:", "GTIFF_DIR:", "GPKG:"};

template <std::size_t N>
bool begins_with_one(const std::string& name, const std::array<std::string_view, N>& starts) {
  return std::ranges::any_of(starts, [&](std::string_view start) { return name.starts_with(start); });
}

InputName refused(std::string fault) {
  InputName name;
  name.fault = std::move(fault);
  return name;
}

InputName of_network(const std::string& name) {
  if (network_is_allowed()) return {"", true, ""};
  return refused(std::string(begins_with_one(name, kWeb) ? "is an address" : "names the network") +
                 ", must be a local file: download it first, or give --allow-network");
}

/// A folder of ESRI, all of whose files are regular.
bool is_geodatabase(const fs::path& path) {
  std::error_code none;
  if (lowercase(path.extension().string()) != ".gdb" || !fs::is_directory(path, none)) return false;
  for (const auto& entry : fs::directory_iterator(path, none))
    if (!entry.is_regular_file(none)) return false;
  return true;
}

/// A file beside `path` that GDAL may read with it (dem.tif.aux.xml, dem.tfw) and that is no regular file.
std::optional<std::string> fault_beside(const fs::path& path) {
  constexpr std::array<const char*, 4> kAfterName{".aux.xml", ".ovr", ".msk", ".xml"};
  constexpr std::array<const char*, 16> kOfStem{".aux", ".rrd", ".hdr", ".prj", ".tfw", ".tifw", ".wld", ".tab",
                                                ".dbf", ".shx", ".cpg", ".qix", ".sbn", ".csvt", ".clr", ".stx"};
  std::vector<std::string> beside;
  for (const char* end : kAfterName) beside.push_back(path.string() + end);
  for (const char* end : kOfStem) beside.push_back(fs::path(path).replace_extension(end).string());
  for (const std::string& file : beside)
    if (const auto fault = fault_of_file(file))
      return "lies beside " + fs::path(file).filename().string() + ", which " + *fault;
  return std::nullopt;
}

InputName of_local(std::string path) {
  if (path.size() > 1 && path.ends_with('/')) path.pop_back();
  if (is_geodatabase(path)) return {path, false, ""};
  if (const auto fault = fault_of_file(path)) return refused(*fault);
  if (const auto fault = fault_beside(path)) return refused(*fault);
  return {path, false, ""};
}

/// The first file on the way down a path that goes on inside of an archive.
InputName of_archive(const std::string& path) {
  std::error_code none;
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string head = path.substr(0, end);
    if (!fs::exists(head, none)) return {};
    if (!fs::is_directory(head, none)) return of_local(head);
    if (end == std::string::npos) return refused("is a folder, must be a file in an archive");
  }
}

/// A name of GDAL's virtual files.
InputName of_virtual(std::string name) {
  const std::string whole = name;
  bool archive = false;
  while (begins_with_one(name, kArchives)) {
    archive = true;
    name.erase(0, name.find('/', 1) + 1);
    if (name.starts_with('{')) name.erase(0, 1), name.erase(std::min(name.size(), name.find('}')), 1);
    if (name.starts_with("vsi")) name.insert(name.begin(), '/');
  }
  if (begins_with_one(name, kNetworks)) return of_network(name);
  if (archive && !name.starts_with("/vsi")) return of_archive(name);
  return refused("is no file that is read, must be a local file, or one in an archive (/vsizip/, /vsitar/, /vsigzip/)");
}

/// One of `kParts` in capitals, if the name is one of a part of a file; else nothing.
std::string kind_of_part(const std::string& name) {
  std::string start = name.substr(0, name.find(':') + 1);
  std::ranges::transform(start, start.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return std::ranges::count(kParts, std::string_view(start)) > 0 ? start : "";
}

bool names_part(const std::string& name) {
  return !kind_of_part(name).empty();
}

/// A name of a part with the file that it stands for.
struct FoundPart {
  PartName name;
  InputName input;  // no file: none is there
};

/// A name taken apart at two places: a colon before the file, and a colon or the end behind it.
PartName taken_apart(const std::string& name, std::size_t before, std::size_t behind) {
  std::size_t from = before + 1, to = behind;
  if (from < to && name[from] == '"') ++from;
  if (from < to && name[to - 1] == '"') --to;
  return {name.substr(0, from), name.substr(from, to - from), name.substr(to)};
}

/// Takes "NETCDF:file.nc:height" or "GTIFF_DIR:2:dem.tif" apart. The file is the longest stretch between colons that is
/// one; where none is there, what stands in its place.
FoundPart of_part(const std::string& name, const fs::path& base) {
  std::vector<std::size_t> colons;
  for (std::size_t at = name.find(':'); at != std::string::npos; at = name.find(':', at + 1)) colons.push_back(at);
  const std::size_t before = kind_of_part(name) == "GTIFF_DIR:" ? colons.back() : colons.front();
  colons.push_back(name.size());
  std::error_code none;
  for (std::size_t from = 0; from + 1 < colons.size(); ++from)
    for (std::size_t to = colons.size() - 1; to > from; --to) {
      const PartName part = taken_apart(name, colons[from], colons[to]);
      if (part.file.empty()) continue;
      const InputName found = part.file.starts_with("/vsi") || begins_with_one(part.file, kWeb)
                                  ? looked_up(part.file)
                                  : of_local((base / part.file).lexically_normal().string());
      if (!found.fault.empty() || found.network || fs::is_regular_file(found.file, none)) return {part, found};
    }
  return {taken_apart(name, before, std::min(name.find(':', before + 1), name.size())), {}};
}

}  // namespace

InputName looked_up(const std::string& name, const fs::path& base) {
  std::error_code none;
  if (name.starts_with('<')) return refused("is a text, must be the name of a file");
  if (name.starts_with("/vsi")) return of_virtual(name);
  if (fs::exists(name, none)) return of_local(name);
  if (names_part(name)) return of_part(name, base).input;
  if (begins_with_one(name, kWeb)) return of_network(name);
  if (name.starts_with("file:")) return refused("is an address, must be the path of a file: leave out file://");
  if (name.find(':') != std::string::npos)
    return refused(
        "must be a file that is there (databases and services are not read): export it first, with gdal_translate or "
        "ogr2ogr, and name that file");
  return {};
}

std::optional<PartName> part_name(const std::string& name, const fs::path& base) {
  return names_part(name) ? std::optional(of_part(name, base).name) : std::nullopt;
}

std::size_t archive_in(const std::string& name) {
  std::string_view rest = name;
  bool archive = false;
  const auto begins = [&](std::string_view kind) {  // GDAL takes an inner name with or without the first slash
    return rest.starts_with(kind) || (archive && rest.starts_with(kind.substr(1)));
  };
  while (std::ranges::any_of(kArchives, begins)) {
    archive = true;
    rest.remove_prefix(rest.find('/', 1) + 1);
    if (rest.starts_with('{')) rest.remove_prefix(1);
  }
  const bool local = archive && !rest.starts_with("vsi") && !rest.starts_with("/vsi");
  return local ? name.size() - rest.size() : std::string::npos;
}

void check_input(const std::string& name) {
  const InputName found = looked_up(name);
  if (!found.fault.empty()) throw InputError(name + ": " + found.fault);
  if (!found.file.empty()) check_vrt(name, found.file);
}

std::string name_for_gdal(const std::string& name) {
  return begins_with_one(name, kWeb) ? "/vsicurl/" + name : name;
}

}  // namespace talus::io
