#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

/// A number as a text table holds it: with a point for decimals, blanks around it; nothing for any other text.
std::optional<double> number_of_cell(const std::string& text);

/// A text without the blanks around it.
std::string trimmed(const std::string& text);

/// Separator of the cells: a comma, semicolon or tab, whichever the header has; the comma if it has several of these;
/// nothing if it has none. GDAL finds it in the same way.
std::optional<char> separator_of(std::string_view header);

/// Throws InputError if the text of a file begins as UTF-16 does.
void refuse_utf16(const std::string& path, std::string_view text);
/// The fault of a zero byte in a table.
inline constexpr const char* kNulFault = "holds a zero byte (NUL), must be text in UTF-8: save the table as CSV again";
/// The fault of a text in another encoding.
inline constexpr const char* kEncodingFault =
    "is not in UTF-8, must be: in a spreadsheet save the table as \"CSV UTF-8\", in QGIS export the layer with the "
    "encoding UTF-8";

/// A text table with a header: commas (or semicolons or tabs, if the header has these), quotation marks as in RFC 4180.
/// Every fault names file, line, column, value and what is allowed.
class CsvTable {
 public:
  struct Row {
    int line;                        ///< in the file, from 1
    std::vector<std::string> cells;  ///< as many as columns, without blanks around them
  };

  /// @param known     columns that may be there, in upper or lower case; any other is refused. Empty: any, as they
  /// stand
  /// @param required  columns that must be there
  /// Throws InputError if it cannot be read, has no header, or has rows of another length.
  CsvTable(std::string path, const std::vector<std::string>& known, const std::vector<std::string>& required);

  /// Function that takes each row of a table as it is read.
  using Take = std::function<void(const CsvTable&, Row&)>;
  /// Gives each row to `take` and keeps none, for tables that need six times the memory of their text if they are kept.
  CsvTable(std::string path, const std::vector<std::string>& known, const std::vector<std::string>& required,
           const Take& take);

  const std::vector<Row>& rows() const { return rows_; }
  /// Gives each row to `take`. Throws InputFaults, with the faults of all rows, if it threw InputError for any.
  void for_each_row(const std::function<void(const Row&)>& take) const;
  const std::vector<std::string>& columns() const { return columns_; }
  bool has(const std::string& column) const { return column_of(column) >= 0; }

  /// The text of a cell; empty if it is empty or the column is not there.
  const std::string& text(const Row& row, const std::string& column) const;
  /// The text of a cell that must not be empty.
  const std::string& name(const Row& row, const std::string& column) const;
  /// A number; nothing where the cell is empty or the column is not there.
  std::optional<double> number(const Row& row, const std::string& column, const Bounds& bounds) const;
  /// A number that must be there.
  double required(const Row& row, const std::string& column, const Bounds& bounds) const;

  /// Throws InputError "blocks.csv:12: mass_kg = -3: must be ...".
  [[noreturn]] void refuse(const Row& row, const std::string& column, const std::string& rule) const;

 private:
  int column_of(const std::string& name) const;
  void read(const std::vector<std::string>& known, const std::vector<std::string>& required, const Take& take);
  void read_header(std::vector<std::string> columns, const std::vector<std::string>& known,
                   const std::vector<std::string>& required);

  std::string path_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace talus::io
