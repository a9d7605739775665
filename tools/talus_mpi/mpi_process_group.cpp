#include "mpi_process_group.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "commands.hpp"

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 28U;  // bytes of a message: MPI counts with an int
constexpr int kSpins = 2000;                           // tests before a waiting process sleeps

}  // namespace

MpiProcessGroup::MpiProcessGroup() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  const MPI_Aint bytes = rank_ == 0 ? sizeof(std::uint64_t) : 0;
  MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD, &counter_, &window_);
  MPI_Win_lock_all(0, window_);
}

MpiProcessGroup::~MpiProcessGroup() {
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
}

/// Waits for all requests. If the run is told to end meanwhile, the leader prints how to resume: another process may
/// have ended for good.
void MpiProcessGroup::wait(std::vector<MPI_Request>& requests) {
  for (int spins = 0;; ++spins) {
    int done = 0;
    MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
    if (done != 0) break;
    if (spins < kSpins) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (!told_ && rank_ == 0 && interrupted() && spins > kSpins + 200) {
      told_ = true;
      say("",
          "told to end, by the user or because another process of the run has ended; "
          "what was kept, if anything, goes on with the same command and --resume");
    }
  }
  requests.clear();
}

void MpiProcessGroup::send(const std::string& bytes, int to, std::vector<MPI_Request>& requests) const {
  for (std::size_t from = 0; from < bytes.size(); from += kPiece)
    MPI_Isend(bytes.data() + from, static_cast<int>(std::min(kPiece, bytes.size() - from)), MPI_BYTE, to, 0,
              MPI_COMM_WORLD, &requests.emplace_back());
}

void MpiProcessGroup::receive(std::string& bytes, int from, std::vector<MPI_Request>& requests) const {
  for (std::size_t at = 0; at < bytes.size(); at += kPiece)
    MPI_Irecv(bytes.data() + at, static_cast<int>(std::min(kPiece, bytes.size() - at)), MPI_BYTE, from, 0,
              MPI_COMM_WORLD, &requests.emplace_back());
}

std::vector<std::string> MpiProcessGroup::gather(std::string bytes) {
  std::uint64_t mine = bytes.size();
  std::vector<std::uint64_t> lengths(rank_ == 0 ? size_ : 0);
  std::vector<MPI_Request> requests(1);
  MPI_Igather(&mine, 1, MPI_UINT64_T, lengths.data(), 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, requests.data());
  wait(requests);
  std::vector<std::string> all(lengths.size());
  if (rank_ != 0) send(bytes, 0, requests);
  for (int r = 1; r < static_cast<int>(all.size()); ++r) {
    all[r].resize(lengths[r]);
    receive(all[r], r, requests);
  }
  wait(requests);
  if (rank_ == 0) all[0] = std::move(bytes);
  return all;
}

std::string MpiProcessGroup::tell(std::string bytes) {
  std::uint64_t length = bytes.size();
  std::vector<MPI_Request> requests(1);
  MPI_Ibcast(&length, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, requests.data());
  wait(requests);
  bytes.resize(length);
  for (std::size_t at = 0; at < length; at += kPiece)
    MPI_Ibcast(bytes.data() + at, static_cast<int>(std::min<std::size_t>(kPiece, length - at)), MPI_BYTE, 0,
               MPI_COMM_WORLD, &requests.emplace_back());
  wait(requests);
  return bytes;
}

std::vector<std::string> MpiProcessGroup::exchange(std::vector<std::string> to) {
  std::vector<std::uint64_t> out(size_), in(size_);
  std::ranges::transform(to, out.begin(), [](const std::string& bytes) { return bytes.size(); });
  std::vector<MPI_Request> requests(1);
  MPI_Ialltoall(out.data(), 1, MPI_UINT64_T, in.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, requests.data());
  wait(requests);
  std::vector<std::string> from(size_);
  from[rank_] = std::move(to[rank_]);
  for (int r = 0; r < size_; ++r) {
    if (r == rank_) continue;
    from[r].resize(in[r]);
    receive(from[r], r, requests);
    send(to[r], r, requests);
  }
  wait(requests);
  return from;
}

std::uint64_t MpiProcessGroup::reduced(std::uint64_t number, MPI_Op how) {
  std::uint64_t result = 0;
  std::vector<MPI_Request> requests(1);
  MPI_Iallreduce(&number, &result, 1, MPI_UINT64_T, how, MPI_COMM_WORLD, requests.data());
  wait(requests);
  return result;
}

void MpiProcessGroup::set_counter(std::uint64_t value) {
  barrier();
  if (rank_ == 0) counter(value, MPI_REPLACE);
  barrier();
}

std::uint64_t MpiProcessGroup::counter(std::uint64_t number, MPI_Op how) {
  const std::lock_guard guard(mutex_);
  std::uint64_t before = 0;
  MPI_Fetch_and_op(&number, &before, MPI_UINT64_T, 0, 0, how, window_);
  MPI_Win_flush(0, window_);
  return before;
}

void MpiProcessGroup::attend() {
  if (rank_ != 0) return;
  const std::lock_guard guard(mutex_);
  int there = 0;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
}
