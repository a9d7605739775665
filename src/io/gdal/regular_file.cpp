#include "regular_file.hpp"

#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "dataset.hpp"
#include "talus/base/error.hpp"
#include "talus/base/open_file.hpp"

namespace talus::io {

namespace {

/// Says what a file is that is no regular one; empty for a regular file.
std::string special_kind(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

std::string megabytes(std::size_t bytes) {
  return std::to_string(bytes >> 20U) + " MB";
}

/// Why the system does not open or read a file, by its error number.
std::string reason(int error, const std::string& path) {
  if (error != ENOENT) return "cannot be read (" + std::system_category().message(error) + ")";
  return "no such file (" + std::filesystem::absolute(path).string() + "), check the path";
}

}  // namespace

std::optional<std::string> fault_of_file(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  const std::string kind = special_kind(status.st_mode);
  if (kind.empty()) return std::nullopt;
  return "is " + kind + ", must be a regular file: " +
         (S_ISDIR(status.st_mode) ? "name a file in it" : "write its content to a file, and name that");
}

std::string read_file(const std::string& path, const std::string& name, const std::string& what, std::size_t most) {
  const auto refuse = [&](const std::string& fault) { throw InputError(name + ": cannot be read: " + fault); };
  if (const auto fault = fault_of_file(path)) refuse(*fault + ", " + what);
  const OpenFile file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));  // waits for no pipe
  struct stat status {};
  if (!file || fstat(file.number(), &status) != 0)
    throw InputError(name + ": " + reason(errno, path) + ": it must be " + what);
  if (!S_ISREG(status.st_mode)) refuse("is no regular file, must be " + what);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > most)
    refuse("has " + megabytes(size) + ", must have at most " + megabytes(most) + ": is it " + what + "?");
  std::string text;
  text.resize(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = read(file.number(), text.data() + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(name + ": " + reason(errno, path) + ": it must be " + what);
    if (count == 0) break;  // has become shorter
    done += static_cast<std::size_t>(count);
  }
  text.resize(done);
  return text;
}

std::string read_start(const std::string& name, std::size_t most) {
  const GdalMessages quiet;
  const VsiFile file(VSIFOpenL(name.c_str(), "rb"));
  std::string text;
  constexpr std::size_t kStep = 1U << 16U;
  while (file && text.size() <= most) {
    const std::size_t before = text.size(), wanted = std::min(kStep, most + 1 - before);
    text.resize(before + wanted);
    const std::size_t count = VSIFReadL(text.data() + before, 1, wanted, file.get());
    text.resize(before + count);
    if (count == 0) break;
  }
  return text;
}

}  // namespace talus::io
