#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "talus/base/error.hpp"

/// Helpers of the fuzz targets. Each target is a program that gets bytes and must end in order, whatever they are:
/// no crash, no hang, no fault that a sanitizer sees, and of exceptions none but InputError. docs/fuzzing.md.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace talus::fuzz {

/// The bytes of a test case, taken one after the other; zeros after the end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }
  /// One of 65536 steps from `low` to `high`.
  double number(double low, double high) {
    const unsigned high_byte = byte();
    return low + (high - low) * ((high_byte << 8) + byte()) / 65535.0;
  }
  /// From 0 to count - 1.
  std::size_t index(std::size_t count) { return byte() % count; }
  bool yes() { return (byte() & 1) != 0; }
  bool empty() const { return left_.empty(); }
  std::string_view rest() const { return {reinterpret_cast<const char*>(left_.data()), left_.size()}; }

 private:
  std::span<const std::uint8_t> left_;
};

inline void write(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

/// Runs what reads wrong input: an InputError with a message is what should come of it. That a name with a line break
/// makes no second line is up to who prints it.
template <class Read>
void refused_or_read(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
}

/// A folder in the memory or on the disk that is removed when the program ends, with a terrain of 20 x 20 cells
/// (dem.tif), zones 1 and 2 (zones.tif) and a polygon (cliffs.geojson).
const std::filesystem::path& site();

}  // namespace talus::fuzz
