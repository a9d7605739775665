#include "input_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "io/gdal/dataset.hpp"

namespace talus::io {

std::vector<std::string> files_of_input(const std::string& path) {
  std::error_code none;
  std::vector<std::string> files;
  if (std::filesystem::is_directory(path, none)) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path, none))
      if (entry.is_regular_file(none)) files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
  }
  files.push_back(path);
  const std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
  if (end == ".vrt" || end == ".VRT") {  // and the rasters that it is made of
    const GdalMessages quiet;
    if (const Dataset mosaic{GDALDataset::Open(path.c_str())}) {
      char** const names = mosaic->GetFileList();
      for (char** name = names; name != nullptr && *name != nullptr; ++name)
        if (*name != path && !std::string_view(*name).ends_with(".aux.xml") &&
            !std::string_view(*name).ends_with(".ovr"))
          files.emplace_back(*name);
      CSLDestroy(names);
    }
    std::sort(files.begin() + 1, files.end());
  }
  if (end == ".shp" || end == ".SHP")
    for (const char* other : {".dbf", ".shx", ".prj"}) {
      std::string name = path.substr(0, path.size() - 4) + other;
      if (!std::filesystem::exists(name, none))
        std::transform(name.end() - 3, name.end(), name.end() - 3,
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      files.push_back(name);
    }
  return files;
}

}  // namespace talus::io
