#pragma once
#include <mpi.h>

#include <mutex>

#include "talus/simulate/plan/process_group.hpp"

/// The process group of all ranks of MPI_COMM_WORLD. At most one, between MPI_Init_thread (MPI_THREAD_SERIALIZED) and
/// MPI_Finalize.
///
/// A waiting process sleeps, so that the leader can write the results with all processors.
class MpiProcessGroup : public talus::ProcessGroup {
 public:
  MpiProcessGroup();
  ~MpiProcessGroup() override;
  MpiProcessGroup(const MpiProcessGroup&) = delete;
  MpiProcessGroup& operator=(const MpiProcessGroup&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::vector<std::string> gather(std::string bytes) override;
  std::string tell(std::string bytes) override;
  std::vector<std::string> exchange(std::vector<std::string> to) override;
  std::uint64_t smallest(std::uint64_t number) override { return reduced(number, MPI_MIN); }
  std::uint64_t largest(std::uint64_t number) override { return reduced(number, MPI_MAX); }
  void set_counter(std::uint64_t value) override;
  std::uint64_t take(std::uint64_t count) override { return counter(count, MPI_SUM); }
  std::uint64_t close() override { return counter(kClosed, MPI_REPLACE); }
  void attend() override;

 private:
  void wait(std::vector<MPI_Request>& requests);
  void barrier() { largest(0); }
  std::uint64_t reduced(std::uint64_t number, MPI_Op how);
  std::uint64_t counter(std::uint64_t number, MPI_Op how);
  void send(const std::string& bytes, int to, std::vector<MPI_Request>& requests) const;
  void receive(std::string& bytes, int from, std::vector<MPI_Request>& requests) const;

  int rank_ = 0, size_ = 1;
  std::mutex mutex_;  // one thread at a time calls MPI
  MPI_Win window_ = MPI_WIN_NULL;
  std::uint64_t* counter_ = nullptr;
  bool told_ = false;
};
