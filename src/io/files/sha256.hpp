#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace talus::io {

/// SHA-256 of bytes that come in pieces. Source: FIPS 180-4; its known answers are in the test.
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// 64 hexadecimal digits. Ends the sum: nothing may be added after it.
  std::string digits();

 private:
  void block(const unsigned char* data);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> buffer_{};
  std::uint64_t length_ = 0;  // bytes so far
};

/// Of bytes.
std::string sha256_of_bytes(std::string_view bytes);

/// Of a file's bytes; of a shapefile those of .shp, .dbf, .shx and .prj, one after the other, as far as they are there;
/// of a VRT also those of the rasters that it is made of; of a folder those of its files in the order of their names.
/// Empty where nothing can be read (a web service, say).
std::string sha256_of_file(const std::string& path);

}  // namespace talus::io
