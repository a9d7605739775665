#include "hazard_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "io/files/compression.hpp"
#include "io/files/posix_bytes.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kWritten = 1U << 22U;  // compressed at once
constexpr std::size_t kBuffer = 1U << 18U;   // read at once
constexpr std::size_t kDigits = 64;          // of the checksum

std::string gzip_name(const std::filesystem::path& file) {
  return "/vsigzip/" + file.string();
}

}  // namespace

HazardWriter::HazardWriter(const std::filesystem::path& file) : file_(file) {
  try {
    output_ = create_file(file_);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
}

HazardWriter::~HazardWriter() {
  if (!output_) return;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void HazardWriter::put(const void* bytes, std::size_t count) {
  buffer_.append(static_cast<const char*>(bytes), count);
  if (buffer_.size() >= kWritten) flush();
}

void HazardWriter::flush() {
  sum_.add(buffer_);
  write(buffer_);
  buffer_.clear();
}

void HazardWriter::write(const std::string& bytes) {
  if (bytes.empty()) return;
  const std::vector<std::byte> gzip = gzipped(std::as_bytes(std::span(bytes)));
  try {
    write_bytes(output_, gzip, end_);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
  end_ += gzip.size();
}

void HazardWriter::finish() {
  flush();
  write(sum_.digits());
  if (output_.close()) return;
  const int cause = errno;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  fail("cannot be written: " + system_text(cause));
}

void HazardWriter::fail(const std::string& cause) const {
  throw std::runtime_error(file_.filename().string() + ": " + cause);
}

HazardReader::HazardReader(const std::filesystem::path& file) : name_(file.string()) {
  if (const auto fault = fault_of_file(name_)) throw InputError(name_ + ": " + *fault);
  stream_.reset(VSIFOpenL(gzip_name(file).c_str(), "rb"));
  if (!stream_) fail();
}

/// Keeps the bytes that are left in the buffer and reads more.
void HazardReader::fill() {
  buffer_.erase(0, next_);
  next_ = 0;
  const std::size_t left = buffer_.size();
  buffer_.resize(left + kBuffer);
  buffer_.resize(left + VSIFReadL(&buffer_[left], 1, kBuffer, stream_.get()));
}

void HazardReader::get(void* bytes, std::size_t count) {
  auto* to = static_cast<char*>(bytes);
  while (count > 0) {
    if (next_ == buffer_.size()) fill();
    const std::size_t part = std::min(count, buffer_.size() - next_);
    if (part == 0) fail();
    std::memcpy(to, &buffer_[next_], part);
    sum_.add({&buffer_[next_], part});
    next_ += part;
    to += part;
    count -= part;
  }
}

std::size_t HazardReader::get_count(std::size_t most) {
  const auto count = get<std::uint32_t>();
  if (count > most) fail();
  return count;
}

void HazardReader::finish() {
  fill();
  const std::string digits = sum_.digits();
  if (buffer_ != digits || digits.size() != kDigits) fail();
}

void HazardReader::fail() const {
  throw InputError(name_ + ": is damaged: it is not as talus run wrote it; run again");
}

}  // namespace talus::io
