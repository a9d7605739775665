#include "checksum.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "input_files.hpp"
#include "io/gdal/aux_xml.hpp"
#include "io/gdal/dataset.hpp"
#include "io/gdal/input_name.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"

namespace talus::io {

namespace {

void require(bool done) {
  if (!done) throw std::runtime_error("OpenSSL: SHA-256 cannot be computed");
}

/// Clears what SQLite writes into the head of a file that is opened and not changed: the kind of its journal, the
/// change counter, and of which change and version the writer was. Source: sqlite.org/fileformat2.html, "The Database
/// Header".
void clear_marks_of_sqlite(std::span<char> head) {
  constexpr std::string_view kMagic("SQLite format 3", 16);
  if (head.size() < 100 || std::string_view(head.data(), kMagic.size()) != kMagic) return;
  for (const auto& [at, count] : {std::pair{18, 2}, {24, 4}, {92, 8}}) std::fill_n(head.begin() + at, count, '\0');
}

struct Sums {
  Sha256 bytes, content;
};

/// Adds of NAME.aux.xml what changes the raster. Whether that is anything.
bool add_auxiliary(Sums& sums, const std::string& path) {
  const std::string text = aux_that_counts(read_start(name_for_gdal(path), kMostVrt));
  sums.bytes.add(text);
  sums.content.add(text);
  return !text.empty();
}

bool add_file(Sums& sums, const std::string& path) {
  if (!looked_up(path).fault.empty()) return false;
  if (path.ends_with(".aux.xml")) return add_auxiliary(sums, path);
  const VsiFile file(VSIFOpenL(name_for_gdal(path).c_str(), "rb"));
  if (!file) return false;
  std::vector<char> bytes(1U << 16);
  bool first = true;
  for (std::size_t n = 0; (n = VSIFReadL(bytes.data(), 1, bytes.size(), file.get())) > 0; first = false) {
    sums.bytes.add({bytes.data(), n});
    if (first) clear_marks_of_sqlite({bytes.data(), n});
    sums.content.add({bytes.data(), n});
  }
  return true;
}

/// Both sums of an input; empty if none of its files can be read.
std::pair<std::string, std::string> sums_of(const std::string& path) {
  start_gdal();
  Sums sums;
  bool any = false;
  for (const std::string& file : files_of_input(path)) any = add_file(sums, file) || any;
  return any ? std::pair{sums.bytes.digits(), sums.content.digits()} : std::pair<std::string, std::string>{};
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
  return sums_of(path).first;
}

InputFile recorded_input(const std::string& role, const std::string& path) {
  const auto [bytes, content] = sums_of(path);
  InputFile input{role, path, bytes, content};
  if (input.sha256.empty())
    throw InputError(path + ": was read, but cannot be read again for its checksum; is it still there?");
  return input;
}

std::string sha256_of_bytes(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digits();
}

std::vector<std::string> changed_inputs(std::span<const InputFile> before, std::span<const InputFile> now) {
  std::vector<std::string> words;
  for (const InputFile& file : now) {
    if (file.role == "scenario" || file.role == kFittedModel) continue;
    const auto was = std::ranges::find(before, file.role, &InputFile::role);
    if (was == before.end() || was->sha256 != file.sha256)
      words.push_back((file.sha256 == file.content ? "" : "perhaps ") +
                      ("another content of the file of " + file.role));
  }
  for (const InputFile& file : before)
    if (std::ranges::find(now, file.role, &InputFile::role) == now.end()) words.push_back("no file of " + file.role);
  return words;
}

}  // namespace talus::io
