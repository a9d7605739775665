#include "talus/base/printable.hpp"

#include <gtest/gtest.h>

#include "talus/base/text.hpp"

namespace talus {
namespace {

TEST(Printable, TextStays) {
  for (const std::string text : {"",
                                 "road 7\n\tS\xC3\xBC"
                                 "d \xE2\x82\xAC \xF0\x9F\xAA\xA8",
                                 "<b>&\"'"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, CommandsAreShown) {
  EXPECT_EQ(printable("\x1b[31m\r\x7f"), "\\x1b[31m\\x0d\\x7f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\x9b31m");  // CSI as one character
  EXPECT_EQ(printable("\xE2\x80\xAE"
                      "gpj"),
            "\\u202egpj");                                             // right to left
  EXPECT_EQ(printable("\xE2\x81\xA6\xEF\xBB\xBF"), "\\u2066\\ufeff");  // isolate, byte order mark
}

TEST(Printable, BytesThatAreNoUtf8AreShown) {
  EXPECT_EQ(printable("\x9B"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("\xC0\xAF"), "\\xc0\\xaf");           // a slash in too many bytes
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");  // half of a pair of UTF-16
  EXPECT_EQ(printable("a\xE2\x82"), "a\\xe2\\x82");         // cut off
  EXPECT_EQ(printable("\xF5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");
}

TEST(IsUtf8, KnowsOtherEncodings) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(
      is_utf8("Stra\xC3\x9F"
              "e"));
  EXPECT_FALSE(
      is_utf8("Stra\xDF"
              "e"));
  EXPECT_FALSE(is_utf8("\xED\xA0\x80"));  // half of a pair of UTF-16
  EXPECT_FALSE(is_utf8("ab\xC3"));
}

TEST(Shortened, CutsNoCharacter) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("ab\xC3\xBC"
                      "d",
                      3),
            "ab...");
}

TEST(NearestName, LongWordsAreNotCompared) {
  const std::vector<std::string> names{"density", "diameter"};
  EXPECT_EQ(nearest_name(std::string(50'000'000, 'd'), names), "");
  EXPECT_EQ(nearest_name("densty", names), "density");
}

}  // namespace
}  // namespace talus
