#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace talus {

/// The processes that trace a run together: one, or the ranks of talus-mpi.
///
/// What is not marked otherwise must be called by all of them, in the same order.
class ProcessGroup {
 public:
  static constexpr std::uint64_t kClosed = std::uint64_t{1} << 62U;

  virtual ~ProcessGroup() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  bool leads() const { return rank() == 0; }

  /// What each of them gives, by rank; at the leader. Elsewhere nothing.
  virtual std::vector<std::string> gather(std::string bytes) { return {std::move(bytes)}; }
  /// What the leader gives.
  virtual std::string tell(std::string bytes) { return bytes; }
  /// What the others give to this one, by rank, where `to[r]` goes to rank r.
  virtual std::vector<std::string> exchange(std::vector<std::string> to) { return to; }
  virtual std::uint64_t smallest(std::uint64_t number) { return number; }
  virtual std::uint64_t largest(std::uint64_t number) { return number; }

  /// A counter that they share: sets it.
  virtual void set_counter(std::uint64_t value) { counter_ = value; }
  /// Adds to the counter and returns what it was. From any process and thread, whenever they want.
  virtual std::uint64_t take(std::uint64_t count) { return counter_.fetch_add(count); }
  /// Sets the counter to `kClosed`, and returns what it was; as `take`.
  virtual std::uint64_t close() { return counter_.exchange(kClosed); }
  /// Now and then, so that others need not wait for what this one must answer; as `take`.
  virtual void attend() {}

 private:
  std::atomic<std::uint64_t> counter_{0};
};

/// This process and no other: of the calling thread, which must live as long as what uses it.
ProcessGroup& alone();

}  // namespace talus
