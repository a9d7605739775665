#include "talus/base/text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace talus {

TEST(TextOf, IsShort) {
  EXPECT_EQ(text_of(0.25), "0.25");
  EXPECT_EQ(text_of(30.0), "30");
  EXPECT_EQ(text_of(1e9), "1000000000");
  EXPECT_EQ(text_of(-9999.0), "-9999");
  EXPECT_EQ(text_of(0.1), "0.1");
}

TEST(TextOf, ReadsBackExactly) {
  for (double value : {1.0 / 3.0, 0.1 + 0.2, 1e-300, 1e300, 9007199254740991.0, std::numeric_limits<double>::max(),
                       123456.789, 1e15, 1e16, 5e-324})
    for (const double v : {value, -value}) EXPECT_EQ(std::strtod(text_of(v).c_str(), nullptr), v) << text_of(v);
}

TEST(Significant, IsAsPrintfWrites) {
  std::array<char, 400> text{};
  for (const double value : {0.0, -0.0, 0.125, 0.375, 2.5, 1.0 / 3.0, 999.95, 999999.5, 1e6, 123456789.0, 1e-5,
                             4.9e-324, -17.25, 1e300, std::numeric_limits<double>::infinity(), std::nan("")})
    for (const int digits : {1, 2, 3, 4, 6}) {
      std::snprintf(text.data(), text.size(), "%.*g", digits, value);
      EXPECT_EQ(significant(value, digits), text.data());
      std::snprintf(text.data(), text.size(), "%.*f", digits - 1, value);
      EXPECT_EQ(with_decimals(value, digits - 1), text.data());
    }
}

TEST(WithDigits, HasNoExponentForLargeNumbers) {
  EXPECT_EQ(with_digits(0.12345, 4), "0.1235");
  EXPECT_EQ(with_digits(14'850.4, 4), "14850");  // kg of a block of 5.5 m3
  EXPECT_EQ(with_digits(243.0, 2), "243");
  EXPECT_EQ(with_digits(99.4, 2), "99");
  EXPECT_EQ(with_digits(99.6, 2), "100");
  EXPECT_EQ(with_digits(-999.6, 3), "-1000");
  EXPECT_EQ(with_digits(1e-5, 3), "1e-05");
}

TEST(Percent, OfAPartIsNeverThatOfTheWhole) {
  EXPECT_EQ(percent(0.2158), "21.6 %");
  EXPECT_EQ(percent(0.994, 2), "99 %");
  EXPECT_EQ(percent(0.9996, 2), "99.96 %");
  EXPECT_EQ(percent(0.999951, 2), "above 99.99 %");
  EXPECT_EQ(percent(1.0, 2), "100 %");
  EXPECT_EQ(percent(1e-10, 2), "below 1e-07 %");
  EXPECT_EQ(percent(0.0), "0 %");
}

TEST(CsvField, IsInQuotationMarksWhereItMust) {
  EXPECT_EQ(csv_field("a b"), "a b");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("5\" pipe"), "\"5\"\" pipe\"");
  EXPECT_EQ(csv_field("a "), "\"a \"");  // readers cut outer blanks off
  EXPECT_EQ(csv_field("\ta"), "\"\ta\"");
  EXPECT_EQ(csv_field(0.125), "0.125");
  EXPECT_EQ(csv_field(std::nan("")), "");
}

TEST(Escaped, IsSafeBetweenTags) {
  EXPECT_EQ(escaped("a < b && c > d"), "a &lt; b &amp;&amp; c &gt; d");
}

TEST(Readable, HasNoExponentAndThreeDigits) {  // also where rounding makes a thousand of it
  for (const double number : {999.4, 999.5, 999.99, 1000.0, 1234.0, 99'950.0, -999.7}) {
    std::string text = readable(number);
    EXPECT_EQ(text.find('e'), std::string::npos) << text;
    for (std::size_t at; (at = text.find("\u00a0")) != std::string::npos;) text.erase(at, 2);
    EXPECT_NEAR(std::atof(text.c_str()), number, 0.005 * std::abs(number)) << text;
  }
}

TEST(NumberIn, IsTheOneAtTheBeginning) {
  EXPECT_EQ(number_in("0.25"), 0.25);
  EXPECT_EQ(number_in("1.5e-07, 3"), 1.5e-7);
  EXPECT_EQ(number_in("-1e+03"), -1000.0);
  EXPECT_TRUE(std::isnan(number_in("none")));
  EXPECT_TRUE(std::isnan(number_in("")));
}

TEST(DecimalNumber, IsTheWholeText) {
  EXPECT_EQ(decimal_number("0.25"), 0.25);
  EXPECT_EQ(decimal_number("-1e+03"), -1000.0);
  for (const char* text : {"", " 500", "500 ", "5.0.0", "0x1p9", "+5", "1e999", "none", "inf", "nan"})
    EXPECT_EQ(decimal_number(text), std::nullopt) << text;
}

TEST(Percent, HasSignificantDigits) {
  EXPECT_EQ(percent(0.2158), "21.6 %");
  EXPECT_EQ(percent(0.2158, 2), "22 %");
  EXPECT_EQ(percent(0.000123), "0.0123 %");
  EXPECT_EQ(percent(4e-286), "below 1e-07 %");
  EXPECT_EQ(percent(0.0), "0 %");
}

TEST(Padded, IsNeverCut) {
  EXPECT_EQ(padded("ab", 4), "ab  ");
  EXPECT_EQ(padded("abcde", 4), "abcde");
}

TEST(Listed, NamesEightAndCountsTheRest) {
  std::vector<std::string> words(8, "a");
  EXPECT_EQ(listed(words), "a, a, a, a, a, a, a, a");
  words.insert(words.end(), 3, "b");
  EXPECT_EQ(listed(words), "a, a, a, a, a, a, a, a and 3 more");
  EXPECT_EQ(listed({}), "");
}

TEST(NearestName, IsTheOneWithFewestChanges) {
  const std::vector<std::string> names{"density", "diameter", "axes"};
  EXPECT_EQ(nearest_name("dmesity", names), "density");  // one letter more, one exchanged
  EXPECT_EQ(nearest_name("Diametre", names), "diameter");
  EXPECT_EQ(nearest_name("axis", names), "axes");
  EXPECT_EQ(nearest_name("velocity", names), "");
  EXPECT_EQ(nearest_name("", names), "");
}

TEST(KnownNames, AreListed) {
  const std::vector<std::string> names{"density", "axes"};
  EXPECT_EQ(known_names("densty", names), "; did you mean 'density'? (known: density, axes)");
  EXPECT_EQ(known_names("trees", names), " (known: density, axes)");
}

}  // namespace talus
