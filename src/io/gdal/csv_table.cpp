#include "csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

/// Throws InputError if a file of vectors stands where a table must.
void refuse_layer(const std::string& path, std::string_view text) {
  constexpr std::string_view kGeoPackage = "SQLite format 3", kShapefile("\0\0\x27\x0A", 4);
  if (text.starts_with(kGeoPackage) || text.starts_with(kShapefile) || text.starts_with('{'))
    throw InputError(path +
                     ": is a layer of vectors, must be a table as text, CSV only: in QGIS, Export > Save Features As > "
                     "CSV with the geometry AS_XY, which gives the columns X and Y");
}

std::string content_of(const std::string& path) {
  std::string text = read_file(path, path, "a table (CSV)", kMostTable);
  refuse_utf16(path, text);
  refuse_layer(path, text);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
  return text;
}

/// The first line that is not empty.
std::string_view first_line(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("\r\n"), text.size()));
  return text.substr(0, text.find_first_of("\r\n"));
}

/// Cuts a text into rows and cells. A cell in quotation marks may hold separators, line ends and doubled marks.
void split(const std::string& text, const std::string& path, const std::function<void(CsvTable::Row)>& take) {
  std::vector<std::string> cells;
  std::string cell;
  int line = 1, start = 1;
  bool quoted = false, was_quoted = false;
  const char separator = separator_of(first_line(text)).value_or(',');
  const auto end_cell = [&] {
    if (!is_utf8(cell)) throw InputError(path + ":" + std::to_string(start) + ": '" + cell + "' " + kEncodingFault);
    cells.push_back(was_quoted ? cell : trimmed(cell));
    cell.clear();
    was_quoted = false;
  };
  const auto end_row = [&] {
    end_cell();
    if (cells.size() > 1 || !cells[0].empty()) take({start, cells});
    cells.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == '\0') throw InputError(path + ":" + std::to_string(line) + ": " + kNulFault);
    if (quoted) {
      if (c != '"')
        cell += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        cell += text[++i];
      else
        quoted = false;
    } else if (c == '"' && !was_quoted && trimmed(cell).empty()) {
      cell.clear();
      quoted = was_quoted = true;
    } else if (c == separator) {
      end_cell();
    } else if (c == '\n') {
      end_row();
      start = line;
    } else if (!was_quoted) {
      cell += c;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      throw InputError(path + ":" + std::to_string(line) +
                       ": text stands after a quotation mark that closes a cell, must be " +
                       (separator == '\t'  ? "a tab"
                        : separator == ';' ? "a semicolon"
                                           : "a comma") +
                       " or the end of the line: is a quotation mark missing?");
    }
  }
  if (quoted)
    throw InputError(path + ":" + std::to_string(start) + ": a quotation mark is open to the end, must be closed");
  if (!cell.empty() || !cells.empty()) end_row();
}

}  // namespace

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::optional<char> separator_of(std::string_view header) {
  std::optional<char> found;
  bool quoted = false;
  for (const char c : header) {
    if (c == '"') quoted = !quoted;
    if (quoted || (c != ',' && c != ';' && c != '\t')) continue;
    if (found && found != c) return ',';
    found = c;
  }
  return found;
}

void refuse_utf16(const std::string& path, std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(path +
                     ": is UTF-16, must be UTF-8: in a spreadsheet save it as \"CSV UTF-8\", or convert it with " +
                     "iconv -f UTF-16 -t UTF-8");
}

std::optional<double> number_of_cell(const std::string& text) {
  const std::string value = trimmed(text);
  if (value.empty()) return std::nullopt;
  double number = 0.0;
  if (value.starts_with("+-")) return std::nullopt;
  const char *first = value.data() + (value.front() == '+' ? 1 : 0), *last = value.data() + value.size();
  const auto [end, error] = std::from_chars(first, last, number);
  return error == std::errc{} && end == last ? std::optional(number) : std::nullopt;
}

CsvTable::CsvTable(std::string path, const std::vector<std::string>& known, const std::vector<std::string>& required)
    : path_(std::move(path)) {
  read(known, required, [this](const CsvTable&, Row& row) { rows_.push_back(std::move(row)); });
}

CsvTable::CsvTable(std::string path, const std::vector<std::string>& known, const std::vector<std::string>& required,
                   const Take& take)
    : path_(std::move(path)) {
  read(known, required, take);
}

void CsvTable::read(const std::vector<std::string>& known, const std::vector<std::string>& required, const Take& take) {
  split(content_of(path_), path_, [&](Row row) {
    if (columns_.empty()) return read_header(std::move(row.cells), known, required);
    if (row.cells.size() != columns_.size())
      throw InputError(path_ + ":" + std::to_string(row.line) + ": has " + std::to_string(row.cells.size()) +
                       " cells, must have " + std::to_string(columns_.size()) + " as the header");
    take(*this, row);
  });
  if (columns_.empty()) throw InputError(path_ + ": is empty, must have a header with " + joined(required));
}

void CsvTable::read_header(std::vector<std::string> columns, const std::vector<std::string>& known,
                           const std::vector<std::string>& required) {
  columns_ = std::move(columns);
  if (std::ranges::any_of(columns_, [](const std::string& c) { return c.find('\r') != std::string::npos; }))
    throw InputError(path_ +
                     ":1: lines must end with a line feed (LF or CR LF), not with CR alone: save it as CSV again");
  const auto other = std::ranges::find_if(columns_, [](const auto& c) { return c.find_first_of(";\t") != c.npos; });
  if (other != columns_.end())
    throw InputError(path_ + ":1: has a column '" + *other +
                     "': cells must all be separated by commas, all by semicolons or all by tabs: save it as CSV");
  for (std::string& column : columns_)  // ID, x and l1_m are id, x and L1_m
    for (const std::string& name : known)
      if (lowercase(column) == lowercase(name)) column = name;
  std::vector<std::string> unknown;
  std::ranges::copy_if(columns_, std::back_inserter(unknown), [&](const std::string& column) {
    return !known.empty() && std::ranges::find(known, column) == known.end();
  });
  if (!unknown.empty())
    throw InputError(path_ + ":1: unknown column" +
                     (unknown.size() == 1 ? " '" + unknown.front() + "'" : "s: " + joined(unknown)) +
                     known_names(unknown.front(), known));
  for (auto column = columns_.begin(); column != columns_.end(); ++column)
    if (std::find(columns_.begin(), column, *column) != column)
      throw InputError(path_ + ":1: column '" + *column + "' is there twice, in whatever case, must be there once");
  for (const std::string& column : required)
    if (!has(column)) throw InputError(path_ + ":1: has no column '" + column + "', must have " + joined(required));
}

void CsvTable::for_each_row(const std::function<void(const Row&)>& take) const {
  FaultList faults(path_);
  for (const Row& row : rows_) faults.attempt([&] { take(row); });
  faults.stop();
}

int CsvTable::column_of(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

const std::string& CsvTable::text(const Row& row, const std::string& column) const {
  static const std::string none;
  const int index = column_of(column);
  TALUS_EXPECT(row.cells.size() == columns_.size(), "a row has the cells of its table");
  return index < 0 ? none : row.cells[static_cast<std::size_t>(index)];
}

const std::string& CsvTable::name(const Row& row, const std::string& column) const {
  const std::string& value = text(row, column);
  if (value.empty()) refuse(row, column, "must not be empty");
  return value;
}

std::optional<double> CsvTable::number(const Row& row, const std::string& column, const Bounds& bounds) const {
  const std::string& value = text(row, column);
  if (value.empty()) return std::nullopt;
  const auto number = number_of_cell(value);
  if (!number)
    refuse(row, column,
           "must be a number" + (bounds.unit == "1" ? "" : " in " + std::string(bounds.unit)) +
               ", with a point for decimals, or empty where it was not measured");
  if (const auto rule = fault_of(bounds, *number)) refuse(row, column, *rule);
  return number;
}

double CsvTable::required(const Row& row, const std::string& column, const Bounds& bounds) const {
  const auto value = number(row, column, bounds);
  if (!value) refuse(row, column, "must be given");
  return *value;
}

void CsvTable::refuse(const Row& row, const std::string& column, const std::string& rule) const {
  throw InputError(path_ + ":" + std::to_string(row.line) + ": " + column + " = '" + text(row, column) + "': " + rule);
}

}  // namespace talus::io
