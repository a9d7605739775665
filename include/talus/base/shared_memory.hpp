#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A piece of memory shared by all processes of one machine.
class SharedPiece {
 public:
  /// Opens the piece, and waits while another process fills it.
  ///
  /// @param name  name of the piece in the system, with a slash in front
  /// Throws std::runtime_error if the machine has no room.
  SharedPiece(const std::string& name, std::size_t bytes);
  ~SharedPiece();
  SharedPiece(const SharedPiece&) = delete;
  SharedPiece& operator=(const SharedPiece&) = delete;

  void* data() const { return data_; }
  /// Whether the piece is filled. If not, this process must fill it and then call `set_filled`.
  bool is_filled() const { return filled_; }
  /// Makes the piece read-only and lets the waiting processes go on.
  void set_filled();

 private:
  struct File {  // a member of its own: closed, and so unlocked, when the constructor throws, too
    int number = -1;
    ~File();
  };

  File file_;
  std::size_t length_;
  void *begin_ = nullptr, *data_ = nullptr;
  bool filled_ = false;
};

/// Memory shared by all processes of one machine that give the same name. The first process that asks for a piece fills
/// it; the others wait until it is filled, and only read. Each process must ask for the same pieces in the same order.
///
/// The destructor removes the names of the pieces. So an object must live until all processes have asked for all
/// pieces. A piece itself remains while it is used.
class SharedMemory {
 public:
  explicit SharedMemory(std::string name) : name_(std::move(name)) {}
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  /// The next piece. Throws std::runtime_error if the machine has no room for it.
  std::shared_ptr<SharedPiece> next(std::size_t bytes);

 private:
  std::string name_;
  std::vector<std::string> pieces_;  // names of those this process has asked for
};

}  // namespace talus
