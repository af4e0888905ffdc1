#include "model/base/hex.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::base {
namespace {

TEST(BytesOfHex, ReadsDigitsOfEitherCase) {
  EXPECT_EQ(BytesOfHex("00fF7a4B"), std::string("\0\xff\x7aK", 4));
  EXPECT_EQ(BytesOfHex(""), "");
}

}  // namespace
}  // namespace duet::base
