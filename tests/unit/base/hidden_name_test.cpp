#include "talus/base/hidden_name.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(HiddenName, BecomesTheFinalNameInMessages) {
  for (const std::string stem : {"map", "a.talus-1", "run.2"})
    for (const std::string extension : {"", ".gpkg"})
      EXPECT_EQ(final_name(hidden_prefix(stem) + "4711" + extension), stem + extension);
  EXPECT_EQ(final_name(".out.talus-123-4"), "out");  // where the first hidden name was taken
}

TEST(HiddenName, LeavesOtherNamesAsTheyAre) {
  for (const std::string name : {"stops.gpkg", ".hidden", ".talus-1", "a.talus-1", ""})
    EXPECT_EQ(final_name(name), name);
}

}  // namespace
}  // namespace talus
