#include "talus/run/memory_limit.hpp"

#include <gdal.h>

#include <algorithm>

#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::run {

std::size_t memory_limit_of(const std::string& text, int threads) {
  if (text.empty()) return 0;
  const double factor = text.back() == 'G' ? 1e9 : text.back() == 'M' ? 1e6 : kNotGiven;
  const double number = decimal_number(std::string_view(text).substr(0, text.size() - 1)).value_or(kNotGiven);
  if (!(number * factor <= 1e15))
    throw InputError("--memory '" + text + "': must be a number with M or G (10^6 or 10^9 bytes), such as 500M or 2G");
  const double least = std::max(200.0, 140.0 + 30.0 * threads);  // measured
  if (!(number * factor >= 1e6 * least))
    throw InputError("--memory '" + text + "' with " + std::to_string(threads) +
                     (threads == 1 ? " thread: must be " : " threads: must be ") + text_of(least) +
                     "M at least; give fewer --threads or more --memory");
  return static_cast<std::size_t>(number * factor);
}

std::unique_ptr<ScratchFile> scratch_file_beside(const std::filesystem::path& results, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  std::filesystem::path parent = io::full_name(results).parent_path();
  while (!std::filesystem::is_directory(parent) && parent.has_relative_path())
    parent = parent.parent_path();  // those below are made with the results
  io::refuse_unwritable(parent);
  GDALSetCacheMax64(static_cast<GIntBig>(bytes / 16));
  return std::make_unique<ScratchFile>(parent.string(), bytes);
}

}  // namespace talus::run
