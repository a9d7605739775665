#include "text_grid.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <vector>

#include "input_name.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "vrt_check.hpp"

namespace talus::io {
namespace {

/// The names of a header of Esri, then those of GRASS.
constexpr std::array kNamesOfHeader = {"ncols",     "nrows",    "xllcorner", "yllcorner",   "xllcenter",
                                       "yllcenter", "cellsize", "dx",        "dy",          "nodata_value",
                                       "byteorder", "north:",   "south:",    "east:",       "west:",
                                       "rows:",     "cols:",    "null:",     "multiplier:", "type:"};

/// Whether GDAL reads a whole word as a number, such as 12.5, 12,5 or 1.#QNAN.
bool is_number_of_grid(std::string word) {
  const char* const first = word.data() + (word[0] == '+' ? 1 : 0);
  double number = 0.0;
  if (std::from_chars(first, word.data() + word.size(), number).ptr == word.data() + word.size()) return true;
  std::ranges::replace(word, ',', '.');
  char* end = nullptr;
  CPLStrtod(word.c_str(), &end);
  return end == word.c_str() + word.size();
}

/// Reads the text of a grid piece by piece: names with their values, then numbers.
class GridText {
 public:
  explicit GridText(const std::string& path) : path_(path) {}

  void add(std::string_view piece) {
    for (const char c : piece) {
      if (kBlanks.find(c) == std::string_view::npos)
        word_ += c;
      else
        end_word();
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
    if (!name_.empty()) {
      if (EQUAL(name_.c_str(), "null:")) null_ = word_;
      name_.clear();
    } else if (numbers_ == 0 && is_name(word_)) {
      name_ = word_;
    } else {
      count();
    }
    word_.clear();
  }

  static bool is_name(const std::string& word) {
    return std::ranges::any_of(kNamesOfHeader, [&](const char* name) { return EQUAL(name, word.c_str()); });
  }

  void count() {
    if (word_ != null_ && !is_number_of_grid(word_))
      throw InputError(path_ + ":" + std::to_string(line_) + ": '" + shortened(word_, 40) +
                       "' is no number, must be one, or the NODATA_value of the header where there is none");
    ++numbers_;
  }

  static constexpr std::string_view kBlanks{" \t\n\r\v\f\0\x1a", 8};  // \x1a: end of a file of DOS
  const std::string& path_;
  std::string word_, name_;  // the name in the header whose value comes next
  std::string null_ = "*";   // word of GRASS for no value
  std::uint64_t numbers_ = 0, line_ = 1;
};

void check_numbers(GDALDataset& dataset, const std::string& path) {
  const VsiFile file(VSIFOpenL(dataset.GetDescription(), "rb"));
  if (!file) return;
  GridText text(path);
  std::vector<char> piece(std::size_t{1} << 20U);
  while (const std::size_t read = VSIFReadL(piece.data(), 1, piece.size(), file.get())) text.add({piece.data(), read});
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  if (text.numbers() != static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows))
    throw InputError(path + ": has " + std::to_string(text.numbers()) + " numbers, its header says " +
                     std::to_string(columns) + " columns x " + std::to_string(rows) +
                     " rows, must be as many: copy it again, or mend its header");
}

/// Checks each raster of a VRT that may be cut off, or has other numbers than its header says, as if it were given
/// alone.
void check_rasters_of_vrt(const std::string& path) {
  const char* const drivers[] = {"AAIGrid", "GRASSASCIIGrid", "ENVI", "PCRaster", nullptr};
  for (const std::string& name : files_of_vrt(path, looked_up(path).file))
    if (GDALIdentifyDriverEx(name.c_str(), GDAL_OF_RASTER, drivers, nullptr) != nullptr)
      check_text_grid(*open_dataset(name, GDAL_OF_RASTER), name);
}

}  // namespace

void check_text_grid(GDALDataset& dataset, const std::string& path) {
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  if (driver == "AAIGrid" || driver == "GRASSASCIIGrid") check_numbers(dataset, path);
  if (driver == "VRT") check_rasters_of_vrt(path);
}

}  // namespace talus::io
