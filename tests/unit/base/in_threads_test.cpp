#include "base/in_threads.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <stdexcept>

namespace talus {
namespace {

TEST(InThreads, CallsEachThreadOnce) {
  std::atomic<int> calls = 0;
  in_threads(
      3, [&] { ++calls; }, [] {});
  EXPECT_EQ(calls, 3);
}

TEST(InThreads, OneExceptionReachesTheCallerAndTheOthersGoOn) {
  std::atomic<int> calls = 0, finished = 0;
  const auto work = [&] {
    if (calls++ != 1) throw std::runtime_error("no memory");
    ++finished;
  };
  std::atomic<int> told = 0;
  EXPECT_THROW(in_threads(3, work, [&] { ++told; }), std::runtime_error);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(finished, 1);
  EXPECT_EQ(told, 2);
}

TEST(InParallel, TakesEachNumberOnceAndNoneAfterAFailure) {
  std::array<std::atomic<int>, 1000> calls{};
  in_parallel(calls.size(), 3, [&](std::size_t i) { ++calls[i]; });
  for (const auto& count : calls) EXPECT_EQ(count, 1);
  std::atomic<std::size_t> last = 0;
  EXPECT_THROW(in_parallel(calls.size(), 1,
                           [&](std::size_t i) {
                             last = i;
                             if (i == 7) throw std::runtime_error("full");
                           }),
               std::runtime_error);
  EXPECT_EQ(last, 7U);
}

}  // namespace
}  // namespace talus
