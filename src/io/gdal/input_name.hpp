#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus::io {

/// The folders that `allow_folder` has named.
const std::vector<std::filesystem::path>& allowed_folders();

/// What the name of an input stands for.
struct InputName {
  std::string file;      ///< the local file behind it: a.zip of "/vsizip/a.zip/dem.tif"; empty if there is none
  bool network = false;  ///< it is an address, and the network is allowed
  std::string fault;     ///< why it is refused; empty: it is allowed, if it is there
};

/// Looks at a name without opening anything.
/// @param base  the folder of relative names of parts, as in NETCDF:file.nc:height; empty: the current one
InputName looked_up(const std::string& name, const std::filesystem::path& base = {});

/// The name of a part of a file, as "NETCDF:file.nc:height" or "GTIFF_DIR:2:dem.tif", taken apart.
struct PartName {
  std::string before, file, after;  ///< "NETCDF:", "file.nc", ":height"
};

/// Takes the name of a part apart; nothing for every other name.
/// @param base  the folder of relative names, as in `looked_up`
std::optional<PartName> part_name(const std::string& name, const std::filesystem::path& base = {});

/// Where the local file begins in the name of a file in archives ("/vsizip/a.zip/dem.tif", also "{a.zip}"): that of the
/// outermost archive. npos for every other name.
std::size_t archive_in(const std::string& name);

/// Throws InputError if the name of an input is not allowed, if it stands for no regular file, or if it is a VRT that
/// names what it may not. Called before GDAL opens the name.
void check_input(const std::string& name);

/// The name as GDAL takes it: an address of the web becomes one of GDAL's files.
std::string name_for_gdal(const std::string& name);

}  // namespace talus::io
