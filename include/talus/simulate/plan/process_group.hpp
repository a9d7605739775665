#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace talus {

/// The processes that trace a run together: one, or the ranks of talus-mpi.
///
/// All processes must call each function, in the same order, unless its comment says otherwise.
class ProcessGroup {
 public:
  static constexpr std::uint64_t kClosed = std::uint64_t{1} << 62U;

  virtual ~ProcessGroup() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  bool leads() const { return rank() == 0; }

  /// Returns the bytes of all processes, by rank, at the leader; nothing elsewhere.
  virtual std::vector<std::string> gather(std::string bytes) { return {std::move(bytes)}; }
  /// Returns the bytes of the leader, in every process.
  virtual std::string tell(std::string bytes) { return bytes; }
  /// Sends `to[r]` to rank r. Returns what this process received, by rank.
  virtual std::vector<std::string> exchange(std::vector<std::string> to) { return to; }
  virtual std::uint64_t smallest(std::uint64_t number) { return number; }
  virtual std::uint64_t largest(std::uint64_t number) { return number; }

  /// Sets the counter that all processes share.
  virtual void set_counter(std::uint64_t value) { counter_ = value; }
  /// Adds to the counter and returns its value before. Any process and thread may call it at any time.
  virtual std::uint64_t take(std::uint64_t count) { return counter_.fetch_add(count); }
  /// Sets the counter to `kClosed` and returns its value before. May be called as `take`.
  virtual std::uint64_t close() { return counter_.exchange(kClosed); }
  /// Answers waiting requests of other processes. To be called now and then, so that they do not wait; as `take`.
  virtual void attend() {}

 private:
  std::atomic<std::uint64_t> counter_{0};
};

/// A group of this process alone. It belongs to the calling thread, which must outlive all users of the group.
ProcessGroup& alone();

}  // namespace talus
