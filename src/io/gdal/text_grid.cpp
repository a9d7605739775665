#include "text_grid.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"

namespace talus::io {
namespace {

/// Whether GDAL reads a whole word as a number, such as 12.5, 12,5 or 1.#QNAN; or it is that for no value of GRASS.
bool is_number_of_grid(std::string word) {
  const char* const first = word.data() + (word[0] == '+' ? 1 : 0);
  double number = 0.0;
  if (std::from_chars(first, word.data() + word.size(), number).ptr == word.data() + word.size()) return true;
  std::ranges::replace(word, ',', '.');
  char* end = nullptr;
  CPLStrtod(word.c_str(), &end);
  return end == word.c_str() + word.size() || word == "*";
}

/// Reads the text of a grid piece by piece: lines of names and values, then numbers.
class GridText {
 public:
  explicit GridText(const std::string& path) : path_(path) {}

  void add(std::string_view piece) {
    for (const char c : piece) {
      const bool end_of_line = c == '\n' || c == '\r';
      if (end_of_line || c == ' ' || c == '\t')
        end_word();
      else
        word_ += c;
      if (end_of_line) in_head_line_ = false, at_start_ = true;
      if (c == '\n') ++line_;
    }
  }

  /// The numbers below the header.
  std::uint64_t numbers() {
    end_word();
    return numbers_;
  }

 private:
  void end_word() {
    if (word_.empty()) return;
    const bool name = std::isalpha(static_cast<unsigned char>(word_[0])) != 0 && !EQUALN(word_.c_str(), "nan", 3);
    if (numbers_ == 0 && at_start_ && name) in_head_line_ = true;
    if (!in_head_line_) count();
    at_start_ = false;
    word_.clear();
  }

  void count() {
    if (!is_number_of_grid(word_))
      throw InputError(path_ + ":" + std::to_string(line_) + ": '" + shortened(word_, 40) +
                       "' is no number, must be one, or the NODATA_value of the header where there is none");
    ++numbers_;
  }

  const std::string& path_;
  std::string word_;
  std::uint64_t numbers_ = 0, line_ = 1;
  bool at_start_ = true, in_head_line_ = false;  // of a line; of a line of the header
};

}  // namespace

void check_text_grid(GDALDataset& dataset, const std::string& path) {
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  if (driver != "AAIGrid" && driver != "GRASSASCIIGrid") return;
  VSILFILE* const file = VSIFOpenL(dataset.GetDescription(), "rb");
  if (file == nullptr) return;
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> closed(file, VSIFCloseL);
  GridText text(path);
  std::vector<char> piece(std::size_t{1} << 20U);
  while (const std::size_t read = VSIFReadL(piece.data(), 1, piece.size(), file)) text.add({piece.data(), read});
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  if (text.numbers() != static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows))
    throw InputError(path + ": has " + std::to_string(text.numbers()) + " numbers, its header says " +
                     std::to_string(columns) + " columns x " + std::to_string(rows) +
                     " rows, must be as many: copy it again, or mend its header");
}

}  // namespace talus::io
