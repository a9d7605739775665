#include "talus/fit/campaign/name_stream.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

/// Values of the authors of FNV-1a (RFC 9923, Appendix C; their test_fnv.c).
TEST(StreamOfName, KnownAnswers) {
  EXPECT_EQ(stream_of_name(""), 0x811c9dc5U);
  EXPECT_EQ(stream_of_name("a"), 0xe40c292cU);
  EXPECT_EQ(stream_of_name("foobar"), 0xbf9cf968U);
}

}  // namespace
}  // namespace talus
