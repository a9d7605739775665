#include "talus/io/files/file_name.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io/files/checksum.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

std::string end_of(const std::string& id) {
  return "-" + sha256_of_bytes(id).substr(0, 8);
}

TEST(FileName, OfOrdinaryIdsIsTheId) {
  for (const std::string id : {"road", "L-12_b",
                               "Stra\xC3\x9F"
                               "e"})
    EXPECT_EQ(file_name_of(id, std::vector{id}), id);
  EXPECT_EQ(file_name_of("L123 km 4,2", std::vector<std::string>{"L123 km 4,2", "road"}), "L123_km_4_2");
  EXPECT_EQ(file_name_of("../../etc", std::vector<std::string>{"../../etc"}), "______etc");
}

TEST(FileName, OfIdsThatWouldShareOneIsToldApart) {
  const std::vector<std::string> ids{"a/b", "a_b", "A_B", "ab"};
  EXPECT_EQ(file_name_of("a/b", ids), "a_b" + end_of("a/b"));
  EXPECT_EQ(file_name_of("a_b", ids), "a_b" + end_of("a_b"));
  EXPECT_EQ(file_name_of("A_B", ids), "A_B" + end_of("A_B"));
  EXPECT_EQ(file_name_of("ab", ids), "ab");
}

TEST(FileName, OfALongIdEndsWithAWholeCharacter) {
  const std::string id = std::string(119, 'x') + "\xC3\xBC\xC3\xBC";  // the 120th and 121st byte are one letter
  EXPECT_EQ(file_name_of(id, std::vector{id}), std::string(119, 'x') + end_of(id));
}

TEST(FileName, OfAnIdThatImitatesAnotherIsRefused) {
  const std::vector<std::string> ids{"a/b", "a_b", "a_b" + end_of("a/b")};
  EXPECT_THROW(file_name_of("a/b", ids), InputError);
  EXPECT_THROW(file_name_of(ids[2], ids), InputError);
}

}  // namespace
}  // namespace talus::io
