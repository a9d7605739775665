#include "named_file.hpp"

#include "io/gdal/dataset.hpp"

namespace talus::io {

std::string absolute_path(const std::string& given, const std::filesystem::path& base) {
  const std::filesystem::path path = (base / given).lexically_normal();
  std::error_code none;
  if (!std::filesystem::exists(path, none) && given.find(':') != std::string::npos) return given;
  return std::filesystem::absolute(path).lexically_normal().string();
}

void check_files(const std::vector<const NamedFile*>& files, std::vector<std::string>& faults) {
  start_gdal();
  for (const NamedFile* file : files) {
    if (file->path.empty()) continue;
    VSIStatBufL status;
    std::error_code none;
    const bool local = std::filesystem::path(file->path).is_absolute() && file->path.rfind("/vsi", 0) != 0;
    if (local && !std::filesystem::exists(file->path, none))
      faults.push_back(file->where + ": no such file (" + file->path + ")");
    if (file->path.rfind("/vsi", 0) == 0 && VSIStatL(file->path.c_str(), &status) != 0)
      faults.push_back(file->where + ": no such file");
  }
}

}  // namespace talus::io
