#include "base/in_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace talus {
namespace {

TEST(InThreads, CallsEachThreadOnce) {
  std::atomic<int> calls = 0;
  in_threads(3, [&] { ++calls; });
  EXPECT_EQ(calls, 3);
}

TEST(InThreads, OneExceptionReachesTheCallerAndTheOthersGoOn) {
  std::atomic<int> calls = 0, finished = 0;
  const auto work = [&] {
    if (calls++ != 1) throw std::runtime_error("no memory");
    ++finished;
  };
  EXPECT_THROW(in_threads(3, work), std::runtime_error);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(finished, 1);
}

}  // namespace
}  // namespace talus
