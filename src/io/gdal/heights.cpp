#include "heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

#include "dataset.hpp"
#include "pixels.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "text_grid.hpp"

namespace talus::io {
namespace {

constexpr double kLowest = -500.0, kHighest = 9000.0;  // heights on the earth, with room to spare [m]
constexpr double kFarFromZero = 50.0;                  // cells of height 0 are suspect where all others are farther [m]
constexpr double kFarApart =
    200.0;  // heights between which the terrain has none are suspect: hardly a cliff is so upright [m]
constexpr int kMostReaders = 4;  // pieces at once, of 18 MB each

/// Reads pieces of the file.
class HeightReader {
 public:
  explicit HeightReader(const std::string& path)
      : path_(path), dataset_(open_dataset(path, GDAL_OF_RASTER)), band_(*dataset_->GetRasterBand(1)), nodata_(band_) {
    int given = 0;
    scale_ = band_.GetScale(&given);
    if (given == 0) scale_ = 1.0;
    offset_ = band_.GetOffset(&given);
    if (given == 0) offset_ = 0.0;
    masked_ = (band_.GetMaskFlags() & GMF_ALL_VALID) == 0;
  }

  void read(const RasterPart& part) {
    const int columns = part.columns(), rows = part.rows();
    values_.resize(std::size_t(columns) * rows);
    if (masked_) mask_.resize(values_.size());
    if (band_.RasterIO(GF_Read, part.left, part.top, columns, rows, values_.data(), columns, rows, GDT_Float64, 0, 0,
                       nullptr) != CE_None ||
        (masked_ && band_.GetMaskBand()->RasterIO(GF_Read, part.left, part.top, columns, rows, mask_.data(), columns,
                                                  rows, GDT_Byte, 0, 0, nullptr) != CE_None))
      throw InputError(path_ + ": rows " + std::to_string(part.top) + " to " + std::to_string(part.bottom - 1) +
                       " cannot be read: " + messages_.take());
  }

  /// A height of the piece that was read last [m]; NaN: missing.
  /// @param i  counted row by row from the north-west
  double height(std::size_t i) const {
    const bool there = !(masked_ && mask_[i] == 0) && !nodata_.is(values_[i]) && std::isfinite(values_[i]);
    return there ? values_[i] * scale_ + offset_ : kNotGiven;
  }

  /// Whether a cell that the mask does not leave out has the nodata value.
  bool is_unmasked_nodata(std::size_t i) const { return masked_ && mask_[i] != 0 && nodata_.is(values_[i]); }
  double nodata() const { return nodata_.value(); }

  /// The value of a height as stored in the file.
  double stored(double height) const { return (height - offset_) / scale_; }

 private:
  const std::string& path_;
  const Dataset dataset_;
  GDALRasterBand& band_;
  const NodataBesideMask nodata_;
  double scale_ = 1.0, offset_ = 0.0;
  bool masked_ = false;
  std::vector<double> values_;
  std::vector<std::uint8_t> mask_;
  GdalMessages messages_;
};

/// The command that makes a stored value one of missing heights. A file has one nodata value: another must not take its
/// place.
std::string command_to_declare(const std::string& path, const std::string& stored) {
  const Dataset file = open_dataset(path, GDAL_OF_RASTER);
  int given = 0;
  const double nodata = file->GetRasterBand(1)->GetNoDataValue(&given);
  if (given == 0) return edit_command(path, "-a_nodata " + stored);
  const bool plain = (file->GetRasterBand(1)->GetMaskFlags() & GMF_PER_DATASET) == 0 &&
                     file->GetRasterBand(1)->GetScale() == 1.0 && file->GetRasterBand(1)->GetOffset() == 0.0;
  if (!plain)  // gdal_calc.py would lose them
    return "a copy in which " + text_of(nodata) + ", the nodata value that the file has already, stands in its place";
  return "gdal_calc.py -A " + shell_word(path) + " --calc='where(A==" + stored + "," + text_of(nodata) +
         ",A)' --NoDataValue=" + text_of(nodata) +
         " --type=Float32 --outfile=mended.tif (the file has the nodata value " + text_of(nodata) + " already)";
}

[[noreturn]] void refuse_height(const std::string& path, int column, int row, double height,
                                const std::string& stored) {
  throw InputError(path + ": height " + text_of(height) + " m in column " + std::to_string(column) + ", row " +
                   std::to_string(row) + " (from 0 in the north-west), must be " + text_of(kLowest) + " to " +
                   text_of(kHighest) + " m: if it stands for missing values, declare it with " +
                   command_to_declare(path, stored) +
                   (height > kHighest && height < 1e6
                        ? "; but if many are as large, they are not in metres: gdal_calc.py -A " + shell_word(path) +
                              " --calc='A*0.1' --type=Float32 --outfile=metres.tif of decimetres (A*0.01 of "
                              "centimetres, A*0.3048 of feet)"
                        : ""));
}

/// Heights in steps of 10 m: what lies far from all others is found. The same in any order of the cells.
class HeightSteps {
 public:
  /// Some cells of like heights.
  struct Group {
    std::uint64_t cells = 0;
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();  // [m]

    void add(const Group& other) {
      cells += other.cells;
      low = std::min(low, other.low), high = std::max(high, other.high);
    }
  };

  void add(double height) { steps_[static_cast<std::size_t>((height - kLowest) / kStep)].add({1, height, height}); }
  void add(const HeightSteps& other) {
    for (std::size_t i = 0; i < steps_.size(); ++i) steps_[i].add(other.steps_[i]);
  }

  /// The cells below the widest range without heights, and those above it.
  std::pair<Group, Group> parted() const {
    Group below, all, above;
    double widest = 0.0;
    for (const Group& step : steps_) {
      if (step.cells > 0 && all.cells > 0 && step.low - all.high > widest) widest = step.low - all.high, below = all;
      all.add(step);
    }
    for (const Group& step : steps_)
      if (step.low > below.high) above.add(step);
    return {below, above};
  }

 private:
  static constexpr double kStep = 10.0;
  std::array<Group, static_cast<std::size_t>((kHighest - kLowest) / kStep) + 1> steps_{};
};

/// Counts of heights: the same in any order of the pieces.
struct Counts {
  std::uint64_t known = 0, zeros = 0, unmasked_nodata = 0;
  double lowest_other = std::numeric_limits<double>::infinity(),  // of those that are not 0 [m]
      highest_other = -std::numeric_limits<double>::infinity();
  HeightSteps steps;

  void add(double height) {
    ++known;
    steps.add(height);
    if (height == 0.0)
      ++zeros;
    else
      lowest_other = std::min(lowest_other, height), highest_other = std::max(highest_other, height);
  }
  void add(const Counts& other) {
    known += other.known;
    zeros += other.zeros;
    unmasked_nodata += other.unmasked_nodata;
    lowest_other = std::min(lowest_other, other.lowest_other);
    highest_other = std::max(highest_other, other.highest_other);
    steps.add(other.steps);
  }
};

/// Cells whose heights are far from all others, as those of missing values that nobody declared; empty if none are.
std::string outliers_text(const std::string& path, const HeightSteps& steps) {
  const auto [below, above] = steps.parted();
  if (below.cells == 0 || !(above.low - below.high >= kFarApart)) return {};
  const bool low = below.cells <= above.cells;
  const HeightSteps::Group& few = low ? below : above;
  const bool one = few.low == few.high;
  const std::string heights = one ? "the height " + text_of(few.low)
                                  : "heights of " + with_digits(few.low, 4) + " to " + with_digits(few.high, 4);
  return path + ": " + std::to_string(few.cells) + (few.cells == 1 ? " cell has " : " cells have ") + heights +
         " m, and all others are " +
         (low ? "at " + text_of(std::floor(above.low)) + " m or higher"
              : "at " + text_of(std::ceil(below.high)) + " m or lower") +
         ": are they missing values, or a fault of the file? Missing values must be declared" +
         (one ? ": " + command_to_declare(path, text_of(HeightReader(path).stored(few.low))) : "");
}

/// Reads one piece. Throws InputError if it cannot be read or holds what is no height.
void read_piece(HeightReader& reader, const std::string& path, const RasterPart& part, Raster<float>& heights,
                Counts& counts) {
  const Grid& grid = heights.grid;
  reader.read(part);
  std::size_t i = 0;
  for (int row = part.top; row < part.bottom; ++row) {
    if (row % 64 == 0) heights.values.memory().keep_below_limit();
    float* out = heights.values.data() + grid.index(part.left, grid.rows - 1 - row);
    for (int column = part.left; column < part.right; ++column, ++i, ++out) {
      const double height = reader.height(i);
      *out = static_cast<float>(height);
      if (reader.is_unmasked_nodata(i)) ++counts.unmasked_nodata;
      if (std::isnan(height)) continue;
      if (!(height >= kLowest && height <= kHighest))
        refuse_height(path, column, row, height, text_of(reader.stored(height)));
      counts.add(height);
    }
  }
}

/// Reads all pieces, several at once. Pieces are handed out in their order; after a fault those before it are still
/// read, so that the fault that is thrown is the first one of the file.
class ParallelReading {
 public:
  ParallelReading(const std::string& path, std::vector<RasterPart> pieces, Raster<float>& heights)
      : path_(path), pieces_(std::move(pieces)), heights_(heights), first_fault_(pieces_.size()) {}

  Counts read(int threads) {
#pragma omp parallel num_threads(threads)
    work();
    if (fault_) std::rethrow_exception(fault_);
    return counts_;
  }

 private:
  void work() noexcept {
    std::size_t piece = 0;  // a file that cannot be opened is a fault of the first one
    try {
      HeightReader reader(path_);
      Counts mine;
      while (next(piece)) read_piece(reader, path_, pieces_[piece], heights_, mine);
      const std::lock_guard guard(mutex_);
      counts_.add(mine);
    } catch (...) {
      const std::lock_guard guard(mutex_);
      if (fault_ && piece >= first_fault_) return;
      fault_ = std::current_exception();
      first_fault_ = piece;
    }
  }

  bool next(std::size_t& piece) {
    const std::lock_guard guard(mutex_);
    piece = next_;
    if (piece >= first_fault_) return false;
    ++next_;
    return true;
  }

  const std::string& path_;
  const std::vector<RasterPart> pieces_;
  Raster<float>& heights_;
  std::mutex mutex_;  // guards the members below
  std::size_t next_ = 0, first_fault_;
  std::exception_ptr fault_;
  Counts counts_;
};

/// Whether one piece can be read without the others. A text is read from its beginning, and a block that is larger than
/// a piece would be unpacked, and kept, by each thread.
bool reads_pieces_apart(GDALDataset& dataset, const RasterPart& piece) {
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  int block_columns = 1, block_rows = 1;
  dataset.GetRasterBand(1)->GetBlockSize(&block_columns, &block_rows);
  return (driver == "GTiff" || driver == "VRT") && block_rows <= piece.rows();
}

}  // namespace

void read_heights(const std::string& path, Terrain& terrain, int threads) {
  const Grid& grid = terrain.heights.grid;
  const Dataset dataset = open_dataset(path, GDAL_OF_RASTER);
  check_text_grid(*dataset, path);
  std::vector<RasterPart> pieces = pieces_of(*dataset->GetRasterBand(1), {0, 0, grid.columns, grid.rows});
  const int most = reads_pieces_apart(*dataset, pieces.front()) ? kMostReaders : 1;
  const int at_once = std::clamp(std::min(threads, static_cast<int>(pieces.size())), 1, most);
  const Counts found = ParallelReading(path, std::move(pieces), terrain.heights).read(at_once);
  if (found.known == 0)
    throw InputError(path + ": all cells are missing values, must hold heights: is its nodata value right? (gdalinfo " +
                     shell_word(path) + ")");
  if (found.unmasked_nodata > 0)
    terrain.warnings.push_back(path + ": the file has a nodata value and a mask, and " +
                               std::to_string(found.unmasked_nodata) +
                               (found.unmasked_nodata == 1 ? " cell has" : " cells have") + " the value " +
                               text_of(HeightReader(path).nodata()) +
                               " where the mask leaves nothing out: taken as "
                               "missing, too");
  const bool above = found.lowest_other > kFarFromZero, below = found.highest_other < -kFarFromZero;
  if (found.zeros > 0 && found.zeros < found.known && (above || below))
    terrain.warnings.push_back(path + ": " + std::to_string(found.zeros) +
                               (found.zeros == 1 ? " cell has" : " cells have") + " the height 0 and all others " +
                               (above ? "more than " + text_of(std::floor(found.lowest_other))
                                      : "less than " + text_of(std::ceil(found.highest_other))) +
                               " m: if 0 stands for missing values, declare it with " + command_to_declare(path, "0"));
  else if (std::string text = outliers_text(path, found.steps); !text.empty())
    terrain.warnings.push_back(std::move(text));
}

}  // namespace talus::io
