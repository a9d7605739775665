#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A piece of memory shared by all processes of one machine.
class SharedPiece {
 public:
  /// @param name  of the system, with a slash at its beginning. Throws std::runtime_error where the machine has no room
  /// Waits while another process fills it.
  SharedPiece(const std::string& name, std::size_t bytes);
  ~SharedPiece();
  SharedPiece(const SharedPiece&) = delete;
  SharedPiece& operator=(const SharedPiece&) = delete;

  void* data() const { return data_; }
  /// Whether another process has filled it; else this one must, and then call `set_filled`.
  bool is_filled() const { return filled_; }
  void set_filled();

 private:
  int file_ = -1;
  std::size_t length_;
  void *begin_ = nullptr, *data_ = nullptr;
  bool filled_ = false;
};

/// Memory shared by all processes of one machine that give the same name. The first that asks for a piece fills it; the
/// others wait for that, and only read. Each process must ask for the same pieces in the same order.
///
/// It lives until all processes have what they want: then the names are given back, and the pieces remain while they
/// are used.
class SharedMemory {
 public:
  explicit SharedMemory(std::string name) : name_(std::move(name)) {}
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  /// The next piece. Throws std::runtime_error where the machine has no room for it.
  std::shared_ptr<SharedPiece> next(std::size_t bytes);

 private:
  std::string name_;
  std::vector<std::string> pieces_;  // that this process has asked for
};

}  // namespace talus
