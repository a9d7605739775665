#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus::io {

/// Refuses a vector file of which GDAL would lose rows or fields without a message: a CSV as `CsvStructure` says, a
/// Shapefile (also zipped, .shz or .shp.zip) without its .dbf or whose .dbf has another number of records; of a folder
/// each of these in it. All else passes, also what is not there. Throws InputError.
void check_vector_file(const std::string& path);

/// A cell of a CSV.
struct CsvCell {
  int line;  ///< in the file, from 1
  std::string text;
};

/// Cells of a CSV that are no numbers as they stand, by column (in small letters): the first of each.
struct OddCells {
  /// Numbers with a decimal comma where semicolons separate: GDAL takes it for a decimal point.
  std::map<std::string, CsvCell> commas;
  /// Cells of the columns x and y that hold a text instead of a number. GDAL gives such a feature no place.
  std::map<std::string, CsvCell> places;
};

/// Those of a CSV; none of other files.
OddCells odd_cells(const std::string& path);

/// Whether GDAL takes a file for a text table by its name; one that is packed too, where GDAL unpacks it (/vsigzip/).
bool is_text_table(const std::string& path);

/// Name of the column of a text table that holds geometries as WKT: wkt, geometry or geom, in any case of letters.
/// Columns x and y beside it are fields. Nothing if it has none.
std::optional<std::string> geometry_column(const std::string& path);

/// The structure of a CSV, read before GDAL reads it. GDAL 3.6 ends with a crash where x stands twice in the header,
/// loses what comes after a quotation mark that is not closed, and takes rows that are too short or too long.
///
/// Throws InputError, with file and line, for a column that is there twice (in any case of letters), a quotation mark
/// that is not closed or stands inside a cell, a zero byte, and a row that has not as many cells as the header.
class CsvStructure {
 public:
  /// @param header  first line of the file, which says what separates cells: a comma, semicolon, tab or blanks
  CsvStructure(std::string path, std::string_view header);

  /// Takes the next characters of the file.
  void take(std::string_view text);
  /// The end of the file.
  void finish();

  /// As the function of this name, of what was taken.
  const OddCells& odd_cells() const { return odd_; }
  /// Names of the columns, in small letters.
  const std::vector<std::string>& columns() const { return columns_; }

 private:
  /// Place of the next character.
  enum class Place { Start, Plain, Quoted, AfterQuote, Closed };

  void take(char c);
  void keep(char c);
  void judge_cell();
  void take_quote();
  void end_cell();
  void end_row();
  void check_header() const;
  [[noreturn]] void refuse(int line, const std::string& fault) const;

  std::string path_;
  char separator_;
  Place place_ = Place::Start;
  char last_ = '\n';
  int line_ = 1, row_line_ = 1, quote_line_ = 0;
  std::size_t cells_ = 0;   // ended ones of this row
  std::size_t filled_ = 0;  // the same up to the last with text
  bool in_header_ = true;
  std::vector<std::string> columns_;  // of the header
  std::string cell_;                  // of the header, and of x and y; with semicolons the beginning of any
  std::vector<bool> is_place_;        // for each column: x or y
  OddCells odd_;
};

}  // namespace talus::io
