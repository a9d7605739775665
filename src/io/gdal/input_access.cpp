#include "talus/io/gdal/input_access.hpp"

#include <filesystem>

#include "input_name.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

struct Access {
  bool network = false;
  std::vector<fs::path> folders;
};

/// Set from the command line and by the scenario, before inputs are opened.
Access& access() {
  static Access allowed;
  return allowed;
}

}  // namespace

void allow_network() {
  access().network = true;
}

bool network_is_allowed() {
  return access().network;
}

void allow_folder(const std::string& folder) {
  access().folders.push_back(fs::absolute(folder).lexically_normal());
}

void allow_folder_of(const std::string& file) {
  allow_folder(fs::absolute(file).parent_path().string());
}

const std::vector<fs::path>& allowed_folders() {
  return access().folders;
}

}  // namespace talus::io
