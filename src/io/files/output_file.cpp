#include "talus/io/files/output_file.hpp"

#include <unistd.h>

#include <system_error>

#include "talus/base/error.hpp"

namespace talus::io {

namespace fs = std::filesystem;

OutputFile::OutputFile(const fs::path& path, const std::string& extension, bool overwrite) : final_(path) {
  const std::string name = path.string();
  if (path.extension() != extension || path.stem().empty())
    throw InputError(name + ": the file must end in " + extension + ", for example result" + extension);
  if (fs::is_directory(path)) throw InputError(name + ": is a folder; give the name of a file");
  if (fs::exists(path) && !overwrite)
    throw InputError(
        name +
        ": the file is there already; give a new name, or --overwrite where the command has it, or remove it first");
  const fs::path folder = fs::absolute(path).parent_path();
  if (!fs::is_directory(folder))
    throw InputError(name + ": there is no such folder for the file to go into; create it first");
  temporary_ = folder / ("." + path.stem().string() + ".talus-" + std::to_string(getpid()) + extension);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::protect(const fs::path& input) const {
  std::error_code none;
  if (fs::equivalent(input, final_, none))
    throw InputError(input.string() + ": is the file that --overwrite would replace; give another name");
}

void OutputFile::commit() {
  fs::rename(temporary_, final_);
}

}  // namespace talus::io
