#include "talus/base/shared_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace talus {
namespace {

/// The files that this process holds open.
std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

TEST(SharedPiece, WithoutRoomItLeavesNoFileOpenAndNoLockBehind) {
  const std::string name = "/talus-test-" + std::to_string(getpid());
  const std::ptrdiff_t before = open_files();
  for (int i = 0; i < 2; ++i)  // the second waited for the lock of the first
    EXPECT_THROW(SharedPiece(name, std::size_t{1} << 46), std::runtime_error);
  EXPECT_EQ(open_files(), before);
  shm_unlink(name.c_str());
}

}  // namespace
}  // namespace talus
