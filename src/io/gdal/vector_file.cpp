#include "vector_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "csv_table.hpp"
#include "dataset.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

bool ends_with(const std::string& path, const char* end) {
  const std::size_t length = std::string_view(end).size();
  return path.size() > length && EQUAL(path.c_str() + path.size() - length, end);
}

/// Whether a blank stands outside quotation marks: GDAL takes it for what separates cells, if nothing else does.
bool has_bare_blank(std::string_view header) {
  bool quoted = false;
  return std::ranges::any_of(header, [&](char c) {
    quoted ^= c == '"';
    return c == ' ' && !quoted;
  });
}

std::string lower_trimmed(const std::string& text) {
  return lowercase(trimmed(text));
}

VsiFile opened(const std::string& path) {
  const GdalMessages quiet;
  return VsiFile(VSIFOpenL(path.c_str(), "rb"));
}

/// How much of a CSV is read.
enum class CsvPart { Header, Whole };

/// Structure of a CSV; nothing if it cannot be read (GDAL says why) or is empty.
std::optional<CsvStructure> structure_of(const std::string& path, CsvPart part = CsvPart::Whole) {
  const VsiFile file = opened(path);
  if (!file) return std::nullopt;
  std::string piece(std::size_t{1} << 16, '\0');
  std::optional<CsvStructure> structure;
  while (const std::size_t count = VSIFReadL(piece.data(), 1, piece.size(), file.get())) {
    std::string_view text(piece.data(), count);
    if (!structure) {
      refuse_utf16(path, text);
      if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
      structure.emplace(path, text.substr(0, text.find_first_of("\r\n")));
    }
    structure->take(text);
    if (part == CsvPart::Header) return structure;
  }
  if (structure) structure->finish();
  return structure;
}

std::string without_prefix(const std::string& path) {
  return path.starts_with("CSV:") ? path.substr(4) : path;
}

std::optional<std::uint64_t> size_of(const std::string& path) {
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0) return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

/// A part of a Shapefile, with its end in small letters or in capitals; nothing if it is not there.
std::optional<std::string> part_of(const std::string& path, const char* small, const char* capitals) {
  const std::string stem = path.substr(0, path.size() - 4);
  for (const char* end : {small, capitals})
    if (size_of(stem + end)) return stem + end;
  return std::nullopt;
}

/// Throws InputError if a .shp is shorter than its header says: its size in words of two bytes, the highest byte first.
void check_size_of_shapes(const std::string& shp) {
  std::array<unsigned char, 28> head{};
  const VsiFile file = opened(shp);
  if (!file || VSIFReadL(head.data(), 1, head.size(), file.get()) != head.size()) return;  // GDAL says why
  std::uint64_t words = 0;
  for (std::size_t i = 24; i < 28; ++i) words = words << 8 | head[i];
  if (*size_of(shp) < 2 * words)
    throw InputError(shp + ": is cut off, must have " + std::to_string(2 * words) + " bytes: copy it again");
}

/// The number of records in a .dbf. Throws InputError if the file is shorter than its header says.
std::uint64_t records_of(const std::string& dbf) {
  std::array<unsigned char, 12> head{};
  const VsiFile file = opened(dbf);
  const bool read = file && VSIFReadL(head.data(), 1, head.size(), file.get()) == head.size();
  const auto number = [&head](std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | head[at + i];
    return value;
  };
  const std::uint64_t records = number(4, 4), size = number(8, 2) + records * number(10, 2);
  if (!read || *size_of(dbf) < size)
    throw InputError(dbf + ": is cut off, must have " + (read ? std::to_string(size) : "at least 32") +
                     " bytes: copy it again");
  return records;
}

void check_shapefile(const std::string& path) {
  const auto dbf = part_of(path, ".dbf", ".DBF"), shx = part_of(path, ".shx", ".SHX");
  const std::string stem = path.substr(0, path.size() - 4), name = std::filesystem::path(stem).filename().string();
  if (!size_of(path)) return;  // GDAL says why
  check_size_of_shapes(path);
  if (!dbf)
    throw InputError(path + ": the fields of its features are in " + name +
                     ".dbf, which is not there: copy all parts of a Shapefile (.shp, .shx, .dbf, .prj); if it is to "
                     "have no fields, convert it: ogr2ogr " +
                     shell_word((path.starts_with("/vsi") ? name : stem) + ".gpkg") + " " + shell_word(path));
  const auto index_size = shx ? size_of(*shx) : std::nullopt;
  if (!index_size || *index_size < 100) return;  // GDAL says why
  const std::uint64_t records = records_of(*dbf), shapes = (*index_size - 100) / 8;
  if (records != shapes)
    throw InputError(path + ": has " + std::to_string(shapes) + " features, and its .dbf has the fields of " +
                     std::to_string(records) +
                     ", must be as many: copy all parts of the Shapefile (.shp, .shx, .dbf) again");
}

/// Checks the Shapefiles at the top of a zip archive, where GDAL looks for them.
void check_zipped_shapefiles(const std::string& path) {
  const std::string archive = "/vsizip/{" + path + "}";
  const GdalMessages quiet;
  const CPLStringList names(VSIReadDir(archive.c_str()));
  for (int i = 0; i < names.size(); ++i)
    if (ends_with(names[i], ".shp")) check_shapefile(archive + "/" + names[i]);
}

/// Throws InputError for a file that gives the columns of a table their types: by it 1.9 of an "Integer" is read as 1.
void refuse_types_beside(const std::string& path) {
  const std::string types = path.substr(0, path.rfind('.')) + ".csvt";
  if (size_of(types))
    throw InputError(types + ": sets the types of the columns of " + std::filesystem::path(path).filename().string() +
                     ", by which values may change (1.9 of an Integer is 1), must not be there: remove it, talus " +
                     "finds the types itself");
}

}  // namespace

bool is_text_table(const std::string& path) {
  const bool packed = path.starts_with("/vsigzip/") && ends_with(path, ".gz");
  const std::string name = packed ? path.substr(0, path.size() - 3) : path;
  return ends_with(name, ".csv") || ends_with(name, ".tsv") || ends_with(name, ".psv");
}

void check_vector_file(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) {
    for (const auto& entry : std::filesystem::directory_iterator(path, none))
      if (entry.is_regular_file(none)) check_vector_file(entry.path().string());
  } else if (is_text_table(path)) {
    structure_of(without_prefix(path));
    refuse_types_beside(path);
  } else if (ends_with(path, ".shp")) {
    check_shapefile(path);
  } else if (ends_with(path, ".shz") || ends_with(path, ".shp.zip")) {
    check_zipped_shapefiles(path);
  }
}

OddCells odd_cells(const std::string& path) {
  if (!is_text_table(path)) return {};
  const auto structure = structure_of(without_prefix(path));
  return structure ? structure->odd_cells() : OddCells{};
}

std::optional<std::string> geometry_column(const std::string& path) {
  const auto structure = structure_of(without_prefix(path), CsvPart::Header);
  if (!structure) return std::nullopt;
  for (const char* name : {"wkt", "geometry", "geom"})
    if (std::ranges::count(structure->columns(), name) > 0) return name;
  return std::nullopt;
}

CsvStructure::CsvStructure(std::string path, std::string_view header)
    : path_(std::move(path)), separator_(separator_of(header).value_or(has_bare_blank(header) ? ' ' : ',')) {}

void CsvStructure::take(std::string_view text) {
  for (const char c : text) take(c);
}

void CsvStructure::take(char c) {
  if (c == '\0') refuse(line_, kNulFault);
  const bool second = c == '\n' && last_ == '\r', line_end = c == '\n' || c == '\r';
  last_ = c;
  if (second) return;
  if (line_end) ++line_;
  if (c == '"') {
    take_quote();
  } else if (place_ == Place::Quoted) {
    keep(c);
  } else if (line_end) {
    end_row();
  } else if (c == separator_) {
    if (c != ' ' || place_ != Place::Start) end_cell();  // several blanks separate once
  } else if (c == ' ' || c == '\t') {
    if (place_ == Place::AfterQuote) place_ = Place::Closed;
    keep(c);
  } else {
    if (place_ == Place::AfterQuote || place_ == Place::Closed)
      refuse(line_, "text stands after a quotation mark that closes a cell (opened in line " +
                        std::to_string(quote_line_) +
                        "), must be a separator or the end of the line: is a quotation mark missing?");
    place_ = Place::Plain;
    keep(c);
  }
}

void CsvStructure::keep(char c) {
  constexpr std::size_t kLongestNumber = 40;
  const bool may_be_number = separator_ == ';' || (cells_ < is_place_.size() && is_place_[cells_]);
  if (in_header_ || (may_be_number && cell_.size() < kLongestNumber)) cell_ += c;
}

void CsvStructure::take_quote() {
  if (place_ == Place::Start) {
    place_ = Place::Quoted;
    quote_line_ = line_;
  } else if (place_ == Place::Quoted) {
    place_ = Place::AfterQuote;
  } else if (place_ == Place::AfterQuote) {  // doubled: one mark of the text
    place_ = Place::Quoted;
  } else {
    refuse(line_, "a quotation mark stands inside a cell: put the whole cell in quotation marks and double the mark");
  }
}

void CsvStructure::end_cell() {
  ++cells_;
  if (place_ != Place::Start) filled_ = cells_;
  place_ = Place::Start;
  if (in_header_)
    columns_.push_back(lower_trimmed(cell_));
  else if (!cell_.empty() && cells_ <= columns_.size())
    judge_cell();
  cell_.clear();
}

void CsvStructure::judge_cell() {
  const std::string text = trimmed(cell_);
  const std::string& column = columns_[cells_ - 1];
  if (const auto comma = cell_.find(','); separator_ == ';' && comma != std::string::npos) {
    std::string number = cell_;
    number[comma] = '.';
    if (number_of_cell(number)) odd_.commas.try_emplace(column, CsvCell{row_line_, text});
  }
  const bool is_number = std::isfinite(number_of_cell(text).value_or(INFINITY));
  if (is_place_[cells_ - 1] && !text.empty() && !is_number) odd_.places.try_emplace(column, CsvCell{row_line_, text});
}

void CsvStructure::end_row() {
  const bool open_cell = separator_ != ' ' || place_ != Place::Start;  // blanks at the end of a line are no cell
  const bool empty = cells_ == 0 && place_ == Place::Start;
  if (!empty && open_cell) end_cell();
  if (!empty && in_header_) {
    check_header();
    in_header_ = false;
    for (const std::string& column : columns_) is_place_.push_back(column == "x" || column == "y");
  } else if (!empty && (cells_ < columns_.size() || filled_ > columns_.size())) {  // spreadsheets end rows with ",,,"
    refuse(row_line_, "has " + std::to_string(cells_) + (cells_ == 1 ? " cell" : " cells") + ", must have " +
                          std::to_string(columns_.size()) + " as the header");
  }
  cells_ = filled_ = 0;
  row_line_ = line_;
}

void CsvStructure::check_header() const {
  const auto is_name = [](const std::string& word) {
    return std::ranges::any_of(word, [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; });
  };
  if (std::ranges::none_of(columns_, is_name)) return;  // no header: GDAL says that x and y are missing
  for (auto column = columns_.begin(); column != columns_.end(); ++column)
    if (!column->empty() && std::find(columns_.begin(), column, *column) != column)
      refuse(row_line_, "column '" + *column + "' is there twice (in any case of letters), must be there once");
}

void CsvStructure::finish() {
  if (place_ == Place::Quoted)
    refuse(
        quote_line_,
        "the quotation mark that opens here is not closed, and all that follows would be lost: close it; a mark that "
        "belongs to a text is written double, in a cell in quotation marks");
  if (cells_ > 0 || place_ != Place::Start) end_row();
}

void CsvStructure::refuse(int line, const std::string& fault) const {
  throw InputError(path_ + ":" + std::to_string(line) + ": " + fault);
}

}  // namespace talus::io
