#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace talus {

/// Memory for what grows with the map: terrain, zones, tallies. On the heap; or, where a limit is set, in a file
/// without a name, of which only as much stays in the process's memory as the limit leaves. The system moves pages to
/// the disk and back: whoever uses the memory sees no difference, and no bit of a result depends on it.
namespace scratch {

/// Takes all memory that is asked for from now on from a file in `folder`. Once, before the first `allocate`.
///
/// @param bytes  that the process should not hold more of, all together
/// Throws std::runtime_error where no such file can be made.
void set_limit(const std::string& folder, std::size_t bytes);

/// Whether there is a limit.
bool is_limited();

/// @return aligned to 16 bytes. Throws std::bad_alloc; std::runtime_error where the disk is full. From any thread.
void* allocate(std::size_t bytes);
/// @param bytes  as it was allocated with
void release(void* memory, std::size_t bytes) noexcept;

/// Where the process comes near the limit: gives the pages of the file back to the system, which keeps what is in them.
/// To be called now and then, from any thread; costs next to nothing where there is no limit, or it is far.
void keep_below_limit() noexcept;

}  // namespace scratch

/// The same for containers.
template <class T>
struct ScratchAllocator {
  using value_type = T;
  ScratchAllocator() = default;
  template <class U>
  ScratchAllocator(const ScratchAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as allocators are
  T* allocate(std::size_t n) { return static_cast<T*>(scratch::allocate(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { scratch::release(p, n * sizeof(T)); }
  template <class U>
  bool operator==(const ScratchAllocator<U>&) const {
    return true;
  }
};

template <class T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace talus
