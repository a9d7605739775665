#include "talus/simulate/plan/work_units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <thread>

namespace talus {
namespace {

/// Shared state of the processes of an imitated process group: a counter, and a place where they wait for each other.
struct Meeting {
  explicit Meeting(int n) : size(n) {}

  /// The smallest or largest of the numbers that they give.
  std::uint64_t meet(std::uint64_t number, bool largest) {
    std::unique_lock lock(mutex);
    const std::uint64_t mine = turn;
    given.push_back(number);
    if (static_cast<int>(given.size()) == size) {
      const auto [low, high] = std::ranges::minmax(given);
      result = largest ? high : low;
      given.clear();
      ++turn;
      all_there.notify_all();
    } else {
      all_there.wait(lock, [&] { return turn != mine; });
    }
    return result;
  }

  int size;
  std::atomic<std::uint64_t> counter{0};
  std::mutex mutex;
  std::condition_variable all_there;
  std::vector<std::uint64_t> given;
  std::uint64_t turn = 0, result = 0;
};

/// A process of the group, imitated by a thread.
class Member : public ProcessGroup {
 public:
  Member(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return meeting_.size; }
  std::uint64_t smallest(std::uint64_t number) override { return meeting_.meet(number, false); }
  std::uint64_t largest(std::uint64_t number) override { return meeting_.meet(number, true); }
  void set_counter(std::uint64_t value) override {
    largest(0);
    if (leads()) meeting_.counter = value;
    largest(0);
  }
  std::uint64_t take(std::uint64_t count) override { return meeting_.counter.fetch_add(count); }
  std::uint64_t close() override { return meeting_.counter.exchange(kClosed); }

 private:
  Meeting& meeting_;
  int rank_;
};

struct Traced {
  std::vector<std::uint64_t> units;  // by all, ascending
  std::uint64_t end = 0;
};

/// Lets a process group trace; its last member asks to stop once it has traced `stop_after` units.
Traced traced(int size, const WorkUnits::Range& range, std::uint64_t chunk, bool fixed, std::size_t stop_after) {
  Meeting meeting(size);
  std::vector<std::vector<std::uint64_t>> done(static_cast<std::size_t>(size));
  std::vector<std::uint64_t> ends(static_cast<std::size_t>(size));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      Member member(meeting, rank);
      WorkUnits units(member, range, chunk, fixed);
      auto& mine = done[static_cast<std::size_t>(rank)];
      do {
        while (const auto taken = units.next()) {
          EXPECT_EQ(taken->number, mine.size());
          mine.push_back(taken->unit);
          if (rank == size - 1 && mine.size() == stop_after) units.stop();
        }
      } while (!units.agree_on_end());
      ends[static_cast<std::size_t>(rank)] = units.end();
      EXPECT_TRUE(std::ranges::is_sorted(mine));
      for (const std::uint64_t unit : mine) EXPECT_TRUE(!fixed || WorkUnits::owns(member, unit, chunk));
    });
  for (std::thread& thread : threads) thread.join();
  Traced all;
  all.end = ends.front();
  for (const std::uint64_t end : ends) EXPECT_EQ(end, all.end);
  for (const auto& mine : done) all.units.insert(all.units.end(), mine.begin(), mine.end());
  std::ranges::sort(all.units);
  return all;
}

/// 300 blocks of a source cell: units of 128, 128 and 44. Source cell 2 begins after the six units of two cells.
TEST(Stratum, IsAUnitOfWork) {
  Scenario scenario;
  scenario.trajectories = 300;
  EXPECT_EQ(units_per_source(scenario), 3U);
  for (const auto& [block, number, blocks] :
       {std::array{0U, 6U, 128U}, {127U, 6U, 128U}, {128U, 7U, 128U}, {256U, 8U, 44U}, {299U, 8U, 44U}}) {
    EXPECT_EQ(stratum_of(scenario, 2, block).number, number) << block;
    EXPECT_EQ(stratum_of(scenario, 2, block).blocks, blocks) << block;
  }
  scenario.trajectories = 128;
  EXPECT_EQ(units_per_source(scenario), 1U);
}

TEST(WorkUnits, EachOnceAndNoneLeftOutWhereverTheyStop) {
  for (const bool fixed : {false, true})
    for (const int size : {1, 2, 3, 5})
      for (const std::uint64_t chunk : {1, 4, 7})
        for (const WorkUnits::Range range : {WorkUnits::Range{0, 40}, {13, 40}, {0, 3}, {38, 40}, {5, 5}})
          for (const std::size_t stop_after : {std::size_t{0}, std::size_t{1}, std::size_t{6}}) {
            SCOPED_TRACE(std::to_string(fixed) + " " + std::to_string(size) + " " + std::to_string(chunk) + " " +
                         std::to_string(range.first) + " " + std::to_string(stop_after));
            const Traced all = traced(size, range, chunk, fixed, stop_after);
            EXPECT_LE(all.end, range.end);
            ASSERT_EQ(all.units.size(), std::max(all.end, range.first) - range.first);
            for (std::size_t i = 0; i < all.units.size(); ++i) ASSERT_EQ(all.units[i], range.first + i);
            if (stop_after == 0) EXPECT_EQ(all.end, range.end);
          }
}

}  // namespace
}  // namespace talus
