#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A temporary file used as memory, so that a process can hold more data than its memory limit allows. The system moves
/// pages to the disk and back: code that uses the memory sees no difference, and no bit of a result depends on it.
///
/// The file is unmapped as a whole, with all data in it. So its owner may drop it without running the destructor of
/// each record, which would read the record back from the disk.
class ScratchFile {
 public:
  /// @param folder  folder of the file
  /// @param bytes   memory limit of the whole process
  /// Throws std::runtime_error, with the folder and a way out, if the file cannot be made.
  ScratchFile(const std::string& folder, std::size_t bytes);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// @return  aligned to 16 bytes. Throws std::bad_alloc; std::runtime_error if the disk is full. From any thread.
  void* allocate(std::size_t bytes);
  /// @param bytes  the same number as at `allocate`
  void release(void* memory, std::size_t bytes) noexcept;
  /// If the process is near the limit, gives the memory of the file back to the system. The data stay in the file. From
  /// any thread.
  void keep_below_limit() const noexcept;

 private:
  class Mapping;
  std::unique_ptr<Mapping> mapping_;
};

/// Place of the data that grow with the map (terrain, zones, tallies): the heap, or a scratch file if the run has a
/// memory limit. A handle, passed by value; the file must outlive everything that uses it.
class MemoryPolicy {
 public:
  MemoryPolicy() = default;  ///< the heap
  /// @param file  null: the heap
  explicit MemoryPolicy(ScratchFile* file) : file_(file) {}

  bool has_limit() const { return file_ != nullptr; }
  /// @return  aligned to 16 bytes. Throws std::bad_alloc; std::runtime_error if the disk is full. From any thread.
  void* allocate(std::size_t bytes) const;
  /// @param bytes  the same number as at `allocate`
  void release(void* memory, std::size_t bytes) const noexcept;
  /// Call it from time to time in a loop over many records, from any thread; costs nothing without a limit.
  void keep_below_limit() const noexcept {
    if (file_ != nullptr) file_->keep_below_limit();
  }
  bool operator==(const MemoryPolicy&) const = default;

 private:
  ScratchFile* file_ = nullptr;
};

/// Allocator of a container with a memory policy. The policy moves with the container, also in a swap.
template <class T>
struct ScratchAllocator {
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  ScratchAllocator() = default;
  ScratchAllocator(MemoryPolicy policy) : memory(policy) {}  // NOLINT(google-explicit-constructor): a handle
  template <class U>
  ScratchAllocator(const ScratchAllocator<U>& other) : memory(other.memory) {}  // NOLINT(google-explicit-constructor)
  // NOLINTBEGIN(bugprone-sizeof-expression): of pointers, too, where a deque keeps some
  T* allocate(std::size_t n) { return static_cast<T*>(memory.allocate(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { memory.release(p, n * sizeof(T)); }
  // NOLINTEND(bugprone-sizeof-expression)
  template <class U>
  bool operator==(const ScratchAllocator<U>& other) const {
    return memory == other.memory;
  }

  MemoryPolicy memory;
};

template <class T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace talus
