#include "checkpoint_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <vector>

#include "io/files/posix_bytes.hpp"
#include "io/gdal/cause_of_failure.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::run {

CheckpointFileWriter::CheckpointFileWriter(const std::filesystem::path& file)
    : path_(file), file_(std::fopen(file.c_str(), "wb")) {
  if (!file_) fail();
}

void CheckpointFileWriter::put(std::string_view bytes) {
  sum_.add(bytes);
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

std::string CheckpointFileWriter::finish() {
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0) fail();
  if (std::fclose(file_.release()) != 0) fail();
  return sum_.digits();
}

void CheckpointFileWriter::fail() const {
  throw std::runtime_error(path_.filename().string() +
                           ": cannot be written: " + io::cause_of_failure(path_.parent_path(), io::system_text(errno)));
}

CheckpointFileReader::CheckpointFileReader(const std::filesystem::path& file, const std::string& sha256)
    : path_(file), file_(io::fault_of_file(file.string()) ? nullptr : std::fopen(file.c_str(), "rb")) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) fail();
  left_ = std::filesystem::file_size(file, error);
  if (!file_ || error) fail();
  Sha256 sum;
  std::vector<char> bytes(std::size_t{1} << 16U);
  while (const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), file_.get()))
    sum.add({bytes.data(), count});
  if (sum.digits() != sha256) fail();
  std::rewind(file_.get());
}

bool CheckpointFileReader::read(void* to, std::size_t count) {
  if (left_ == 0) return false;
  if (count > left_ || std::fread(to, 1, count, file_.get()) != count) fail();
  left_ -= count;
  return true;
}

std::string CheckpointFileReader::get(std::size_t count) {
  if (count > left_) fail();
  std::string bytes(count, '\0');
  if (count > 0) read(bytes.data(), count);
  return bytes;
}

void CheckpointFileReader::finish() {
  if (left_ > 0) fail();
}

void CheckpointFileReader::fail() const {
  throw InputError(path_.string() + ": is damaged or missing: it is not as Talus wrote it; run this part again");
}

}  // namespace talus::run
