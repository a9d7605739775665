#include "talus/base/scratch.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "talus/base/expect.hpp"
#include "talus/base/open_file.hpp"

namespace talus {
namespace {

constexpr std::size_t kReserved = std::size_t{1} << 43U;  // addresses, not memory
constexpr std::size_t kStep = std::size_t{64} << 20U;     // the file grows by this
constexpr std::size_t kGrain = 16, kSmall = 1024;         // pieces up to kSmall are multiples of kGrain
constexpr std::size_t kPiece = 4096;                      // larger pieces are multiples of this
constexpr std::size_t kSlab = std::size_t{1} << 16U;      // small pieces are cut from slabs
constexpr double kNear = 0.85;                            // share of the limit; data outside the file need room too

/// Size of the piece that is taken for a number of bytes.
std::size_t rounded(std::size_t bytes) {
  const std::size_t unit = bytes <= kSmall ? kGrain : kPiece;
  return std::max(unit, (bytes + unit - 1) / unit * unit);
}

}  // namespace

/// The file, mapped into the address space, with lists of its free pieces by size.
class ScratchFile::Mapping {
 public:
  Mapping(std::string folder, std::size_t limit) : folder_(std::move(folder)), limit_(limit) {
    open();
    status_ = OpenFile(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC));
    void* const reserved = mmap(nullptr, kReserved, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (reserved != MAP_FAILED) begin_ = static_cast<char*>(reserved);
    if (file_ && status_ && begin_ != nullptr) return;
    const int cause = errno;
    unmap();
    throw std::runtime_error(folder_ + ": no file for --memory can be made there (" +
                             std::system_category().message(cause) + "); write the results to another folder");
  }
  ~Mapping() { unmap(); }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  void* take(std::size_t bytes) {
    const std::lock_guard guard(mutex_);
    TALUS_EXPECT(begin_ != nullptr && bytes % kGrain == 0, "the file is open and its pieces are aligned");
    std::vector<void*>& list = free_[bytes];
    if (!list.empty()) {
      void* const memory = list.back();
      list.pop_back();
      return memory;
    }
    if (bytes > kSmall) return extend(bytes);
    if (slab_left_ < bytes) {
      slab_ = static_cast<char*>(extend(kSlab));
      slab_left_ = kSlab;
    }
    void* const memory = slab_;
    slab_ += bytes;
    slab_left_ -= bytes;
    return memory;
  }

  void give_back(void* memory, std::size_t bytes) noexcept {
    const std::lock_guard guard(mutex_);
    TALUS_EXPECT(bytes % kGrain == 0, "a piece comes back as it was taken");
    try {
      free_[bytes].push_back(memory);
    } catch (const std::bad_alloc&) {  // nobody takes the piece again: it goes with the file
    }
  }

  void keep_below_limit() const noexcept {
    std::array<char, 128> text{};
    unsigned long pages = 0;
    if (pread(status_.number(), text.data(), text.size() - 1, 0) <= 0 ||
        std::sscanf(text.data(), "%*u %lu", &pages) != 1)
      return;
    if (static_cast<double>(pages) * static_cast<double>(page_) < kNear * static_cast<double>(limit_)) return;
    madvise(begin_, mapped_, MADV_DONTNEED);  // the mapping is shared, so the data stay in the file
  }

 private:
  void open() {
    file_ = OpenFile(::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (file_) return;
    std::string name = folder_ + "/.talus-scratch-XXXXXX";  // for a file system without O_TMPFILE
    file_ = OpenFile(mkostemp(name.data(), O_CLOEXEC));
    if (file_) unlink(name.c_str());
  }

  void unmap() const {
    if (begin_ != nullptr) munmap(begin_, kReserved);
  }

  char* extend(std::size_t bytes) {
    if (used_ + bytes > mapped_) {
      const std::size_t step = (used_ + bytes - mapped_ + kStep - 1) / kStep * kStep;
      int full = EINTR;
      while (full == EINTR)
        full = posix_fallocate(file_.number(), static_cast<off_t>(mapped_.load()), static_cast<off_t>(step));
      if (full != 0)
        throw std::runtime_error(folder_ + ": the file for --memory cannot grow to " +
                                 std::to_string((mapped_ + step) / 1'000'000) + " MB there (" +
                                 std::system_category().message(full) +
                                 "); make room on this disk, or write the results to another one");
      if (mapped_ + step > kReserved || mmap(begin_ + mapped_, step, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED,
                                             file_.number(), static_cast<off_t>(mapped_.load())) == MAP_FAILED)
        throw std::bad_alloc();
      mapped_ += step;
    }
    char* const memory = begin_ + used_;
    used_ += bytes;
    return memory;
  }

  std::string folder_;
  OpenFile file_, status_;
  const long page_ = sysconf(_SC_PAGESIZE);
  char* begin_ = nullptr;
  std::size_t limit_ = 0, used_ = 0;
  std::atomic<std::size_t> mapped_{0};
  char* slab_ = nullptr;
  std::size_t slab_left_ = 0;
  std::map<std::size_t, std::vector<void*>> free_;
  std::mutex mutex_;
};

ScratchFile::ScratchFile(const std::string& folder, std::size_t bytes)
    : mapping_(std::make_unique<Mapping>(folder, bytes)) {}

ScratchFile::~ScratchFile() = default;

void* ScratchFile::allocate(std::size_t bytes) {
  return mapping_->take(rounded(bytes));
}

void ScratchFile::release(void* memory, std::size_t bytes) noexcept {
  if (memory != nullptr) mapping_->give_back(memory, rounded(bytes));
}

void ScratchFile::keep_below_limit() const noexcept {
  mapping_->keep_below_limit();
}

void* MemoryPolicy::allocate(std::size_t bytes) const {
  if (file_ != nullptr) return file_->allocate(bytes);
  void* const memory = std::malloc(bytes);
  if (memory == nullptr && bytes > 0) throw std::bad_alloc();
  return memory;
}

void MemoryPolicy::release(void* memory, std::size_t bytes) const noexcept {
  if (file_ != nullptr)
    file_->release(memory, bytes);
  else
    std::free(memory);
}

}  // namespace talus
