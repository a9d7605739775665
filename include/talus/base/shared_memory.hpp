#pragma once
#include <cstddef>
#include <string>

namespace talus {

/// Memory of which the processes of one machine have one copy. The first that asks for it fills it; the others wait
/// for that, and only read. Each process must ask for the same ones in the same order.
class SharedMemory {
 public:
  /// From here on processes share that give the same name. Until `end`, which gives the names back: once all have what
  /// they want.
  static void begin(const std::string& name);
  static void end() noexcept;
  static bool is_on();

  /// Throws std::runtime_error where the machine has no room for it.
  explicit SharedMemory(std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  void* data() const { return data_; }
  /// Whether another process has filled it; else this one must, and then say so.
  bool is_filled() const { return filled_; }
  void set_filled();

 private:
  int file_ = -1;
  std::size_t length_;
  void *begin_ = nullptr, *data_ = nullptr;
  bool filled_ = false;
};

}  // namespace talus
