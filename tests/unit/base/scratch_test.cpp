#include "talus/base/scratch.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <numeric>
#include <utility>

namespace talus {
namespace {

constexpr std::size_t kAtOnce = 1;  // a limit [byte] that every process is above: pages are given back at each call

std::string folder() {
  return std::filesystem::temp_directory_path().string();
}

/// Addresses that this process has taken [pages].
unsigned long pages_of_addresses() {
  unsigned long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  EXPECT_EQ(std::fscanf(file, "%lu", &pages), 1);
  std::fclose(file);
  return pages;
}

TEST(ScratchFile, HoldsItsValuesWhenItsPagesAreGivenBack) {
  ScratchFile file(folder(), kAtOnce);
  const MemoryPolicy memory(&file);
  ScratchVector<std::uint64_t> values(memory);
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    values.push_back(i * i);
    if (i % 1000 == 0) memory.keep_below_limit();
  }
  memory.keep_below_limit();
  for (std::uint64_t i = 0; i < 100'000; ++i) ASSERT_EQ(values[i], i * i);
}

TEST(ScratchFile, TakesReleasedMemoryAgain) {
  ScratchFile file(folder(), kAtOnce);
  void* const first = file.allocate(100);
  file.release(first, 100);
  EXPECT_EQ(file.allocate(112), first) << "both are 112 bytes in steps of 16";
  EXPECT_NE(file.allocate(112), first);
}

TEST(ScratchFile, GivesItsAddressesBackAtItsEnd) {
  const unsigned long before = pages_of_addresses();
  for (int i = 0; i < 100; ++i) {  // each reserves 2^43 bytes of the 2^47 that a process has
    const ScratchFile file(folder(), kAtOnce);
    EXPECT_GT(pages_of_addresses(), before + (1UL << 30U));
  }
  EXPECT_LT(pages_of_addresses(), before + 1000);
}

TEST(ScratchFile, CannotBeMadeInAFolderThatIsNotThere) {
  EXPECT_THROW(ScratchFile("/no/such/folder", kAtOnce), std::runtime_error);
}

TEST(ScratchVector, KeepsItsPolicyWhenItIsMovedOrSwapped) {
  ScratchFile file(folder(), kAtOnce);
  const MemoryPolicy memory(&file);
  ScratchVector<int> here(1000, 7, memory), other;
  const int* const data = here.data();
  other.swap(here);
  EXPECT_EQ(other.data(), data);
  EXPECT_TRUE(other.get_allocator().memory.has_limit());
  EXPECT_FALSE(here.get_allocator().memory.has_limit());
  here = std::move(other);
  EXPECT_EQ(here.data(), data);
  EXPECT_EQ(std::accumulate(here.begin(), here.end(), 0), 7000);
}

}  // namespace
}  // namespace talus
