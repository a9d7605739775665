#include "talus/base/shell.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(ShellWord, PlainTextsStay) {
  for (const char* text : {"dem.tif", "/a/b-c_d.tif", "a=b", "EPSG:2056"}) EXPECT_EQ(shell_word(text), text);
}

TEST(ShellWord, OthersAreInSingleQuotes) {
  EXPECT_EQ(shell_word("my site.tif"), "'my site.tif'");
  EXPECT_EQ(shell_word("site.gpkg|layername=a"), "'site.gpkg|layername=a'");
  EXPECT_EQ(shell_word("$(rm x);"), "'$(rm x);'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace talus
