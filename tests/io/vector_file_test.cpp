#include "io/gdal/vector_file.hpp"

#include "files.hpp"

namespace talus::io::test {

namespace {

void read(const std::string& text, std::size_t piece = 1000) {
  CsvStructure csv("t.csv", text.substr(0, text.find_first_of("\r\n")));
  for (std::size_t at = 0; at < text.size(); at += piece) csv.take(std::string_view(text).substr(at, piece));
  csv.finish();
}

void refuses(const std::string& text, const std::vector<std::string>& words) {
  for (const std::size_t piece : {1U, 3U, 1000U}) expect_input_error([&] { read(text, piece); }, words);
}

}  // namespace

TEST(CsvStructure, TakesWhatIsWhole) {
  for (const char* text : {"x,y\n1,2\n", "x,y\r\n1,2\r\n", "x,y\r1,2\r3,4", "x;y;\n1;2;\n", "x\ty\n1\t2",
                           "x y\n1   2 \n", "x,y\n\n1,2\n\n", "a,b\n\"1,\n\"\"2\"\"\",\" \" \n", "a,b\n,\n",
                           "a\n\"\"\n", "a,,\n1,2,3\n", "1,1\n2,3\n", "", "\n"})
    EXPECT_NO_THROW(read(text)) << text;
}

TEST(CsvStructure, TakesEmptyCellsAfterTheLastColumn) {
  for (const char* text : {"x,y\n1,2,,\n3,4\n", "x;y\r\n1;2;  ;\r\n"}) EXPECT_NO_THROW(read(text)) << text;
  refuses("x,y\n1,2,,3\n", {"t.csv:2: has 4 cells, must have 2"});
}

TEST(CsvStructure, NamesTheLine) {
  refuses("x,x,y\n", {"t.csv:1:", "column 'x' is there twice"});
  refuses("x, X ,y\n1,2,3\n", {"t.csv:1:", "'x'"});
  refuses("x,y\n1\n", {"t.csv:2: has 1 cell, must have 2"});
  refuses("x,y\r\n1,2\r\n1,2,3\r\n", {"t.csv:3: has 3 cells, must have 2"});
  refuses("x,y\n\"a\nb\",2\n\n1\n", {"t.csv:5: has 1 cell"});
  refuses("x,y\n1,2\n\"3,4\n5,6\n", {"t.csv:3: the quotation mark that opens here is not closed"});
  refuses("x,y\n\"1,2\n\"3,4\n", {"t.csv:3: text stands after a quotation mark", "opened in line 2"});
  refuses("x,y\n1,\"2\" \"3\"\n", {"t.csv:2: a quotation mark stands inside a cell"});
  refuses(std::string("x,y\n1,2\n1,\0\n", 13), {"t.csv:3: holds a zero byte"});
}

OddCells odd_cells_in(const std::string& text) {
  CsvStructure csv("t.csv", text.substr(0, text.find_first_of("\r\n")));
  csv.take(text);
  csv.finish();
  return csv.odd_cells();
}

std::string words_of(const std::map<std::string, CsvCell>& cells) {
  std::string words;
  for (const auto& [column, cell] : cells) words += column + ":" + std::to_string(cell.line) + "=" + cell.text + " ";
  return words;
}

TEST(CsvStructure, FindsDecimalCommasWhereSemicolonsSeparate) {
  const auto found = [](const std::string& text) { return words_of(odd_cells_in(text).commas); };
  EXPECT_EQ(found("x;Name;D\n1;a;2.5\n\n1,5;a, b;\"1,200\" \n1,6;c;7\n"), "d:4=1,200 x:4=1,5 ");
  EXPECT_EQ(found("x;wkt\n1;LINESTRING (1 2,3 4)\n1,2,3;1.2,5\n"), "");
  EXPECT_EQ(found("x,d\n1,\"1,5\"\n"), "");  // GDAL takes it for a text
}

TEST(CsvStructure, FindsWhatIsNoNumberInThePlaceOfACoordinate) {
  const auto found = [](const std::string& text) { return words_of(odd_cells_in(text).places); };
  EXPECT_EQ(found("name,X,y\na, 2650304 ,+1.5e3\n,,\nb,\" 7 \",-.5\n"), "");
  EXPECT_EQ(found("name,X,y\na,1,2\nb, 12 m,3\nc,x,4\n"), "x:3=12 m ");
  EXPECT_EQ(found("y\tx\n\"1'170'600\"\tnan\n"), "x:2=nan y:2=1'170'600 ");
  EXPECT_EQ(found("y;x\n0x10;1,5\n"), "x:2=1,5 y:2=0x10 ");
  EXPECT_EQ(found("y x\n5d3 1e400\n"), "x:2=1e400 y:2=5d3 ");  // which GDAL takes for 5 and for infinity
}

TEST(TextTable, IsKnownByItsName) {
  for (const char* name : {"a.csv", "a.CSV", "b/a.tsv", "a.psv", "/vsigzip/a.csv.gz", "/vsigzip/a.tsv.GZ"})
    EXPECT_TRUE(is_text_table(name)) << name;
  for (const char* name : {"a.txt", "csv", "a.csv.gz", "/vsizip/a.zip", "/vsigzip/a.gz", "a.csv.shp"})
    EXPECT_FALSE(is_text_table(name)) << name;
}

}  // namespace talus::io::test
