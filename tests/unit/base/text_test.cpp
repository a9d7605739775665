#include "talus/base/text.hpp"

#include <gtest/gtest.h>

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
