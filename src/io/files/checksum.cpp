#include "checksum.hpp"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "input_files.hpp"
#include "io/gdal/dataset.hpp"
#include "io/gdal/input_name.hpp"
#include "talus/base/error.hpp"

namespace talus::io {

namespace {

void require(bool done) {
  if (!done) throw std::runtime_error("OpenSSL: SHA-256 cannot be computed");
}

bool add_file(Sha256& sum, const std::string& path) {
  if (!looked_up(path).fault.empty()) return false;
  VSILFILE* file = VSIFOpenL(name_for_gdal(path).c_str(), "rb");
  if (file == nullptr) return false;
  std::vector<char> bytes(1U << 16);
  for (std::size_t n = 0; (n = VSIFReadL(bytes.data(), 1, bytes.size(), file)) > 0;) sum.add({bytes.data(), n});
  VSIFCloseL(file);
  return true;
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const {
  EVP_MD_CTX_free(context);
}

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256::add(std::string_view bytes) {
  require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
}

std::string Sha256::digits() {
  std::array<unsigned char, 32> sum{};
  require(EVP_DigestFinal_ex(context_.get(), sum.data(), nullptr) == 1);
  std::string text;
  for (const unsigned char byte : sum) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 0xF];
  }
  return text;
}

std::string sha256_of_file(const std::string& path) {
  start_gdal();
  Sha256 sum;
  bool any = false;
  for (const std::string& file : files_of_input(path)) any = add_file(sum, file) || any;
  return any ? sum.digits() : "";
}

InputFile recorded_input(const std::string& role, const std::string& path) {
  InputFile input{role, path, sha256_of_file(path)};
  if (input.sha256.empty())
    throw InputError(path + ": was read, but cannot be read again for its checksum; is it still there?");
  return input;
}

std::string sha256_of_bytes(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digits();
}

}  // namespace talus::io
