#pragma once
#include <memory>
#include <string>
#include <string_view>

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

/// Of bytes.
std::string sha256_of_bytes(std::string_view bytes);

/// Of the bytes of all files of an input (`files_of_input`) that are there, one after the other. Empty where nothing
/// can be read (a web service, say).
std::string sha256_of_file(const std::string& path);

}  // namespace talus::io
