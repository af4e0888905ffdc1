#include "model/base/nearest.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::base {
namespace {

using ::testing::Optional;

const std::vector<std::string>& Classes() {
  static const auto& classes =
      *new std::vector<std::string>{"kick", "push", "punch", "shake_hands"};
  return classes;
}

TEST(Nearest, FindsANameWithOneEdit) {
  EXPECT_THAT(Nearest("kik", Classes()), Optional(std::string("kick")));    // left out
  EXPECT_THAT(Nearest("kickk", Classes()), Optional(std::string("kick")));  // added
  EXPECT_THAT(Nearest("kock", Classes()), Optional(std::string("kick")));   // changed
  EXPECT_THAT(Nearest("kcik", Classes()), Optional(std::string("kick")));   // swapped
  EXPECT_THAT(Nearest("Kick", Classes()), Optional(std::string("kick")));   // case
  EXPECT_THAT(Nearest("shakehands", Classes()), Optional(std::string("shake_hands")));
}

TEST(Nearest, FindsTheNearestAndAmongSeveralTheFirst) {
  EXPECT_THAT(Nearest("puncch", {"punt", "punch"}), Optional(std::string("punch")));
  EXPECT_THAT(Nearest("cat", {"bat", "hat"}), Optional(std::string("bat")));
}

TEST(Nearest, IsAbsentForOtherWords) {
  EXPECT_EQ(Nearest("dance", Classes()), std::nullopt);
  EXPECT_EQ(Nearest("", Classes()), std::nullopt);
  EXPECT_EQ(Nearest("kick", {}), std::nullopt);
  EXPECT_EQ(Nearest("kick", Classes()), std::nullopt);  // is one of them
  EXPECT_EQ(Nearest(std::string(1000, 'k'), Classes()), std::nullopt);
}

TEST(DidYouMean, EndsAMessage) {
  EXPECT_EQ(DidYouMean("kik", Classes()), "; did you mean kick?");
  EXPECT_EQ(DidYouMean("dance", Classes()), "");
}

}  // namespace
}  // namespace duet::base
