#pragma once
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <utility>

namespace talus {

/// Owns the number of an open file (its descriptor) and closes it. False: there is none.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int number) : number_(number) {}
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~OpenFile() { close(); }

  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  /// @return whether the system has taken all that was written; else `errno` has the cause
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_ = -1;
};

struct CloseBufferedFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// A file that is read or written through a buffer, and closed with its owner.
using BufferedFile = std::unique_ptr<std::FILE, CloseBufferedFile>;

}  // namespace talus
