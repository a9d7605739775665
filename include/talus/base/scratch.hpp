#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A file without a name that takes the place of memory, of which only as much stays in the process's memory as a limit
/// leaves. The system moves pages to the disk and back: whoever uses the memory sees no difference, and no bit of a
/// result depends on it.
///
/// All that lies in it ends with it: the file is unmapped as a whole. So its owner may drop it without a destructor of
/// each record, which would fetch the record from the disk.
class ScratchFile {
 public:
  /// @param folder  where the file is made
  /// @param bytes   that the process should not hold more of, all together
  /// Throws std::runtime_error where no such file can be made.
  ScratchFile(const std::string& folder, std::size_t bytes);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// @return aligned to 16 bytes. Throws std::bad_alloc; std::runtime_error where the disk is full. From any thread.
  void* allocate(std::size_t bytes);
  /// @param bytes  as it was allocated with
  void release(void* memory, std::size_t bytes) noexcept;
  /// Where the process comes near the limit: gives the pages of the file back to the system, which keeps what is in
  /// them. From any thread.
  void keep_below_limit() const noexcept;

 private:
  class Mapping;
  std::unique_ptr<Mapping> mapping_;
};

/// Where lies what grows with the map (terrain, zones, tallies): on the heap, or in a scratch file where the run has a
/// limit of memory. A handle, handed down by value; the file must outlive what uses it.
class MemoryPolicy {
 public:
  MemoryPolicy() = default;  ///< the heap
  /// @param file  null: the heap
  explicit MemoryPolicy(ScratchFile* file) : file_(file) {}

  bool has_limit() const { return file_ != nullptr; }
  /// @return aligned to 16 bytes. Throws std::bad_alloc; std::runtime_error where the disk is full. From any thread.
  void* allocate(std::size_t bytes) const;
  /// @param bytes  as it was allocated with
  void release(void* memory, std::size_t bytes) const noexcept;
  /// To be called now and then by whoever goes through many records, from any thread; costs nothing without a limit.
  void keep_below_limit() const noexcept {
    if (file_ != nullptr) file_->keep_below_limit();
  }
  bool operator==(const MemoryPolicy&) const = default;

 private:
  ScratchFile* file_ = nullptr;
};

/// A memory policy for containers, which keep it when they are moved or swapped.
template <class T>
struct ScratchAllocator {
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  ScratchAllocator() = default;
  ScratchAllocator(MemoryPolicy policy) : memory(policy) {}  // NOLINT(google-explicit-constructor): as a handle is
  template <class U>
  ScratchAllocator(const ScratchAllocator<U>& other) : memory(other.memory) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t n) { return static_cast<T*>(memory.allocate(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { memory.release(p, n * sizeof(T)); }
  template <class U>
  bool operator==(const ScratchAllocator<U>& other) const {
    return memory == other.memory;
  }

  MemoryPolicy memory;
};

template <class T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace talus
