#include "talus/fit/diagnose/diagnosis_rules.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>

namespace talus::test {
namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream file(std::string(TALUS_SOURCE_DIR "/") + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Fields of a header with their values: "name = 0.25" outside of comments.
std::map<std::string, double> fields_of(const std::string& header) {
  std::map<std::string, double> fields;
  std::istringstream lines(text_of_file(header));
  const std::regex field("(\\w+) = ([0-9.]+)");
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find("//"));
    for (std::sregex_iterator m(line.begin(), line.end(), field), end; m != end; ++m)
      fields[(*m)[1]] = std::stod((*m)[2]);
  }
  return fields;
}

/// Rows "| `name` | value |" of the tables of a page.
std::map<std::string, double> rows_of(const std::string& page) {
  std::map<std::string, double> rows;
  const std::string text = text_of_file(page);
  const std::regex row("\\| `(\\w+)` \\| ([0-9.]+) \\|");
  for (std::sregex_iterator m(text.begin(), text.end(), row), end; m != end; ++m) rows[(*m)[1]] = std::stod((*m)[2]);
  return rows;
}

TEST(DiagnosisRules, StandInTheDocsWithTheirValues) {
  std::map<std::string, double> fields = fields_of("include/talus/fit/diagnose/diagnosis_rules.hpp");
  fields.merge(fields_of("include/talus/fit/calibrate/search_rules.hpp"));
  EXPECT_EQ(fields.size(), 51U);
  EXPECT_EQ(rows_of("docs/diagnosis-method.md"), fields);
}

}  // namespace
}  // namespace talus::test
