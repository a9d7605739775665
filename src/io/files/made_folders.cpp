#include "talus/io/files/made_folders.hpp"

#include <system_error>

#include "talus/base/error.hpp"

namespace talus::io {

namespace fs = std::filesystem;

MadeFolders::~MadeFolders() {
  std::error_code not_empty;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, not_empty);
}

void MadeFolders::make(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error) && !error && at != at.parent_path();
       at = at.parent_path())
    missing.push_back(at);
  for (auto at = missing.rbegin(); at != missing.rend(); ++at)
    if (fs::create_directory(*at, error)) made_.push_back(*at);  // else another process has made it, or it is an error
  if (fs::is_directory(folder, error)) return;
  throw InputError(folder.string() + ": no folder can be made there" + (error ? " (" + error.message() + ")" : "") +
                   "; give an output folder where you may write");
}

}  // namespace talus::io
