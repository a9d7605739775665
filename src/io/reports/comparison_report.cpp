#include "talus/io/reports/comparison_report.hpp"

#include <algorithm>

#include "io/files/json.hpp"
#include "markup.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"

namespace talus::io {
namespace {

using Cells = std::vector<std::string>;

/// A row of the table: what the figure is, its value of each run, of two runs the change.
Cells cells_of(const ComparedFigure& figure, bool has_change) {
  Cells cells{figure.name, figure.quantity, figure.unit};
  cells.insert(cells.end(), figure.values.begin(), figure.values.end());
  if (has_change) cells.push_back(figure.change);
  return cells;
}

Cells header_of(std::size_t runs) {
  Cells cells{"name", "quantity", "unit"};
  for (std::size_t run = 0; run < runs; ++run) cells.push_back(letter_of_run(run));
  if (runs == 2) cells.emplace_back("B - A");
  return cells;
}

/// A table in Markdown, its columns as wide as their longest cell.
std::string table_of(std::vector<Cells> rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (Cells& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      for (std::size_t at = row[i].find('|'); at != std::string::npos; at = row[i].find('|', at + 2))
        row[i].insert(at, "\\");
      widths[i] = std::max(widths[i], row[i].size());
    }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i) text += "| " + padded(rows[r][i], widths[i]) + " ";
    text += "|\n";
    if (r > 0) continue;
    for (const std::size_t width : widths) text += "| " + std::string(width, '-') + " ";
    text += "|\n";
  }
  return text;
}

}  // namespace

std::string comparison_csv(const std::vector<ComparedFigure>& figures) {
  const std::size_t runs = figures.front().values.size();
  std::string text = "table";
  for (const std::string& cell : header_of(runs)) text += "," + cell;
  text += "\n";
  for (const ComparedFigure& figure : figures) {
    text += figure.table;
    for (const std::string& cell : cells_of(figure, runs == 2)) text += "," + csv_field(cell);
    text += "\n";
  }
  return text;
}

std::string comparison_markdown(const std::vector<ComparedFigure>& figures, const std::vector<std::string>& notes) {
  const std::size_t runs = figures.front().values.size();
  std::string text = "# Comparison of runs\n";
  for (const auto& [table, title] :
       {std::pair{"run", "Runs"}, {"setting", "Settings that differ"}, {"raster", "Rasters"}, {"screen", "Screens"}}) {
    std::vector<Cells> rows{header_of(runs)};
    for (const ComparedFigure& figure : figures)
      if (figure.table == table) rows.push_back(cells_of(figure, runs == 2));
    text += "\n## " + std::string(title) + "\n\n" + (rows.size() > 1 ? table_of(rows) : "None.\n");
  }
  text += "\n## Notes\n\n";
  for (const std::string& note : notes) text += "- " + note + "\n";
  return markdown_without_html(text);
}

std::string comparison_json(const ComparisonRecord& record) {
  Json json;
  json["program"] = "talus";
  json["version"] = version();
  json["command"] = record.command;
  json["runs"] = record.folders;
  json["notes"] = record.notes;
  json["files"] = record.files;
  return json_text(json);
}

}  // namespace talus::io
