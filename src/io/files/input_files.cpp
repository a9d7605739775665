#include "input_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "io/gdal/dataset.hpp"
#include "talus/base/error.hpp"
#include "talus/io/gdal/layer_name.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> files_in_folder(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder, none))
    if (entry.is_regular_file(none)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// The rasters that a VRT is made of, in the order of their names.
std::vector<std::string> rasters_of_vrt(const std::string& path) {
  Dataset mosaic;
  std::vector<std::string> files;
  try {
    mosaic = open_dataset(path, GDAL_OF_RASTER);
  } catch (const InputError&) {
    return files;
  }
  char** const names = mosaic->GetFileList();
  for (char** name = names; name != nullptr && *name != nullptr; ++name)
    if (*name != path && !std::string_view(*name).ends_with(".aux.xml") && !std::string_view(*name).ends_with(".ovr"))
      files.emplace_back(*name);
  CSLDestroy(names);
  std::sort(files.begin(), files.end());
  return files;
}

/// The files beside a .shp, with names in capitals if there is none in small letters.
std::vector<std::string> parts_of_shapefile(const std::string& path) {
  std::error_code none;
  std::vector<std::string> files;
  for (const char* part : {".dbf", ".shx", ".prj"}) {
    std::string name = path.substr(0, path.size() - 4) + part;
    if (!fs::exists(name, none))
      std::transform(name.end() - 3, name.end(), name.end() - 3,
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    files.push_back(name);
  }
  return files;
}

}  // namespace

std::vector<std::string> files_of_input(const std::string& name) {
  std::error_code none;
  const std::string path = file_of_layer(name);
  if (fs::is_directory(path, none)) return files_in_folder(path);
  const std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
  std::vector<std::string> files{path}, others;
  if (end == ".vrt" || end == ".VRT") others = rasters_of_vrt(path);
  if (end == ".shp" || end == ".SHP") others = parts_of_shapefile(path);
  files.insert(files.end(), others.begin(), others.end());
  return files;
}

}  // namespace talus::io
