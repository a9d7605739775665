#include "talus/run/in_every_process.hpp"

#include <gtest/gtest.h>

#include "talus/base/error.hpp"

namespace talus::run {
namespace {

/// The leader of a group of two. The other process has this fault, or none if it is empty.
class LeaderOfTwo : public ProcessGroup {
 public:
  explicit LeaderOfTwo(std::string fault) : fault_(std::move(fault)) {}
  int size() const override { return 2; }
  std::vector<std::string> gather(std::string bytes) override { return {std::move(bytes), fault_}; }

 private:
  std::string fault_;
};

std::string message_of(ProcessGroup& processes, const std::function<void()>& step) {
  try {
    in_every_process(processes, step);
  } catch (const GroupInputError& error) {
    return error.what();
  }
  return "none";
}

const std::function<void()> kGood = [] {}, kBad = [] { throw InputError("mine"); };

TEST(InEveryProcess, ThrowsTheFirstMessageOfAll) {
  LeaderOfTwo all_good(""), other_bad("other");
  EXPECT_EQ(message_of(all_good, kGood), "none");
  EXPECT_EQ(message_of(all_good, kBad), "mine");
  EXPECT_EQ(message_of(other_bad, kGood), "other") << "a process without a fault stops too";
  EXPECT_EQ(message_of(other_bad, kBad), "mine") << "by rank";
}

TEST(InEveryProcess, LeavesTheErrorOfASingleProcessAlone) {
  EXPECT_THROW(in_every_process(alone(), kBad), InputError);
  EXPECT_NO_THROW(in_every_process(alone(), kGood));
}

TEST(InEveryProcess, LetsOtherExceptionsPass) {
  LeaderOfTwo all_good("");
  EXPECT_THROW(in_every_process(all_good, [] { throw std::length_error("no memory"); }), std::length_error);
}

}  // namespace
}  // namespace talus::run
