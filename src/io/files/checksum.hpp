#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "talus/io/origin/origin.hpp"

struct evp_md_ctx_st;

namespace talus::io {

/// SHA-256 of bytes that come in pieces, by OpenSSL. Source: FIPS 180-4; its known answers are in the test.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// 64 hexadecimal digits. Ends the sum: nothing may be added after it.
  std::string digits();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// SHA-256 of bytes.
std::string sha256_of_bytes(std::string_view bytes);

/// SHA-256 of an input: of the bytes of its files (`files_of_input`), one after the other; of NAME.aux.xml only of what
/// changes the raster (`aux_that_counts`). Empty if none can be read.
std::string sha256_of_file(const std::string& path);

/// The record of an input that was read. Throws InputError if it cannot be read again: a run without its checksum could
/// not be compared with another.
InputFile recorded_input(const std::string& role, const std::string& path);

/// "another content of the file of dem", for each file that differs between two records of a plan. Without those of the
/// scenario, of which the settings tell. A GeoPackage that a program has opened differs "perhaps".
std::vector<std::string> changed_inputs(std::span<const InputFile> before, std::span<const InputFile> now);

}  // namespace talus::io
