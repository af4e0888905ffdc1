#include "model/cleanup/contacts.h"

#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr double kRate = 30;
constexpr float kFloor = 0.05f;

// Stands at x = 0, swings for half a second to x = 1, and stands there for `frames`.
std::vector<Vec3> Step(int frames) {
  std::vector<Vec3> foot(30, Vec3{0, kFloor, 0});
  for (int t = 1; t < 15; ++t) foot.push_back({static_cast<float>(t) / 15, kFloor + 0.3f, 0});
  foot.insert(foot.end(), static_cast<std::size_t>(frames), Vec3{1, kFloor, 0});
  return foot;
}

TEST(FindContacts, FindsWhereAndHowLongAFootStands) {
  const std::vector<Contact> contacts = FindContacts(Step(30), kFloor, kRate);
  ASSERT_THAT(contacts, SizeIs(2));
  EXPECT_EQ(contacts[0].begin, 0);
  EXPECT_NEAR(contacts[0].end, 30, 4);
  EXPECT_NEAR(contacts[0].place.x, 0, 0.02);
  EXPECT_NEAR(contacts[1].begin, 44, 4);
  EXPECT_EQ(contacts[1].end, 74);
  EXPECT_NEAR(contacts[1].place.x, 1, 0.02);
}

TEST(FindContacts, IgnoresATouchThatIsTooShort) {
  ContactOptions options;
  options.shortest_seconds = 0.8;
  const std::vector<Contact> contacts = FindContacts(Step(15), kFloor, kRate, options);
  ASSERT_THAT(contacts, SizeIs(1));
  EXPECT_EQ(contacts[0].begin, 0);
  EXPECT_THAT(FindContacts(Step(15), kFloor, kRate), SizeIs(2));
}

}  // namespace
}  // namespace duet::cleanup
