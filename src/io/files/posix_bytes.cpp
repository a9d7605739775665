#include "posix_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace talus::io {

std::string system_text(int cause) {
  return cause == ENOSPC ? "the disk is full" : std::system_category().message(cause);
}

namespace {

[[noreturn]] void fail(const char* what, int cause) {
  throw std::runtime_error(std::string(what) + ": " + system_text(cause));
}

/// Calls pread or pwrite until all bytes are moved.
template <class Byte, class Move>
void move_all(std::span<Byte> bytes, std::uint64_t offset, const char* what, Move move) {
  while (!bytes.empty()) {
    const ssize_t moved = move(bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) fail(what, moved < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(moved));
    offset += static_cast<std::uint64_t>(moved);
  }
}

}  // namespace

OpenFile create_file(const std::filesystem::path& path) {
  constexpr mode_t kModeOfFiles = 0666;
  OpenFile file(open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, kModeOfFiles));
  if (!file) fail("cannot be created", errno);
  return file;
}

void write_bytes(const OpenFile& file, std::span<const std::byte> bytes, std::uint64_t offset) {
  move_all(bytes, offset, "cannot be written", [&file](const std::byte* from, std::size_t count, off_t at) {
    return pwrite(file.number(), from, count, at);
  });
}

void read_bytes(const OpenFile& file, std::span<std::byte> bytes, std::uint64_t offset) {
  move_all(bytes, offset, "cannot be written",  // a file of ours that cannot be read back
           [&file](std::byte* to, std::size_t count, off_t at) { return pread(file.number(), to, count, at); });
}

}  // namespace talus::io
