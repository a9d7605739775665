#include "talus/base/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <system_error>

namespace talus {
namespace {

constexpr std::size_t kHead = 4096;  // holds the mark 'filled'; the data begin on a new page

std::runtime_error failure(const std::string& what) {
  return std::runtime_error("memory that processes share " + what + ": " + std::system_category().message(errno) +
                            "; is /dev/shm large enough for the terrain?");
}

}  // namespace

SharedPiece::SharedPiece(const std::string& name, std::size_t bytes) : length_(kHead + bytes) {
  file_.number = shm_open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file_.number < 0) throw failure("cannot be opened");
  while (flock(file_.number, LOCK_EX) != 0)  // until the process that fills it is done, or has ended
    if (errno != EINTR) throw failure("cannot be locked");
  do errno = posix_fallocate(file_.number, 0, static_cast<off_t>(length_));
  while (errno == EINTR);
  if (errno != 0) throw failure("cannot be had");
  begin_ = mmap(nullptr, length_, PROT_READ | PROT_WRITE, MAP_SHARED, file_.number, 0);
  if (begin_ == MAP_FAILED) throw failure("cannot be mapped");
  data_ = static_cast<char*>(begin_) + kHead;
  filled_ = *static_cast<const std::uint64_t*>(begin_) != 0;
  if (filled_) set_filled();
}

void SharedPiece::set_filled() {
  *static_cast<std::uint64_t*>(begin_) = 1;
  filled_ = true;
  flock(file_.number, LOCK_UN);
  mprotect(begin_, length_, PROT_READ);
}

SharedPiece::~SharedPiece() {
  if (begin_ != nullptr && begin_ != MAP_FAILED) munmap(begin_, length_);
}

SharedPiece::File::~File() {
  if (number >= 0) ::close(number);
}

SharedMemory::~SharedMemory() {
  for (const std::string& piece : pieces_) shm_unlink(piece.c_str());
}

std::shared_ptr<SharedPiece> SharedMemory::next(std::size_t bytes) {
  pieces_.push_back("/" + name_ + "-" + std::to_string(pieces_.size()));
  return std::make_shared<SharedPiece>(pieces_.back(), bytes);
}

}  // namespace talus
