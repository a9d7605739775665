#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace talus::io {

/// A file that the input names.
struct NamedFile {
  std::string path;   ///< absolute; empty: none
  std::string where;  ///< "scenario.toml:3: dem = 'dem.tif'" or "flag --dem = 'dem.tif'", for messages
};

/// The absolute path of a file given relative to `base`; of a part of a file (NETCDF:file.nc:height) or a file in an
/// archive (/vsizip/a.zip/dem.tif) its name with that of the file or archive. Other names (/vsicurl/..., https:...)
/// stay as they are, for GDAL.
std::string absolute_path(const std::string& given, const std::filesystem::path& base);

/// Why a scenario, which is text in UTF-8, cannot hold a name; empty: it can.
std::string fault_of_encoding(const std::string& name, const std::string& what = "its path",
                              const std::string& way_out = "rename the file or the folder");

/// Adds a fault for each file whose path the complete scenario of a run could not hold (`fault_of_encoding`).
void check_encoding(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults);

/// Adds a fault for each file that is named and not there, or not allowed (docs/security.md).
void check_files(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults);

}  // namespace talus::io
