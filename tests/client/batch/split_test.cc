#include "client/batch/split.h"

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/batch/record.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

std::string Leader(int number) { return base::Sha256Hex(std::to_string(number)); }

TEST(SplitOf, SharesAreThoseOfTheRecipe) {
  const Splits splits{0.1, 0.3};
  std::map<std::string, int> leaders;
  for (int i = 0; i < 10000; ++i) ++leaders[SplitOf(splits, Leader(i))];
  EXPECT_NEAR(leaders["validation"], 1000, 150);
  EXPECT_NEAR(leaders["test"], 3000, 250);
  EXPECT_NEAR(leaders["train"], 6000, 250);
}

TEST(SplitOf, LargerSharesMoveLeadersOnlyOutOfTraining) {
  const Splits before{0.1, 0.2}, after{0.3, 0.4};
  for (int i = 0; i < 1000; ++i) {
    const std::string was = SplitOf(before, Leader(i));
    if (was == "train") continue;
    EXPECT_EQ(SplitOf(after, Leader(i)), was) << i;
  }
}

TEST(SplitOfRecord, GroupsAreNeverDivided) {
  const Splits splits{0.25, 0.25};
  std::map<std::string, int> groups;
  for (int person = 0; person < 100; ++person) {
    std::set<std::string> found, without;
    for (int take = 0; take < 20; ++take) {
      nlohmann::ordered_json record = {{"leader_sha256", Leader(20 * person + take)}};
      without.insert(SplitOfRecord(splits, record));
      record["group"] = absl::StrCat("person ", person);
      found.insert(SplitOfRecord(splits, record));
    }
    EXPECT_EQ(found.size(), 1u);
    EXPECT_GT(without.size(), 1u);
    ++groups[*found.begin()];
  }
  EXPECT_GT(groups["test"], 10);
  EXPECT_GT(groups["validation"], 10);
  EXPECT_GT(groups["train"], 30);
}

TEST(SplitOf, FollowsTheFirstEightDigits) {
  const Splits splits{0.25, 0.25};
  EXPECT_EQ(SplitOf(splits, "3fffffff00"), "test");
  EXPECT_EQ(SplitOf(splits, "4000000000"), "train");
  EXPECT_EQ(SplitOf(splits, "bfffffff"), "train");
  EXPECT_EQ(SplitOf(splits, "c0000000"), "validation");
}

TEST(SplitOf, EveryLeaderTrainsWithoutShares) {
  for (const char* sha256 : {"00000000", "ffffffff", "", "no digest"}) {
    EXPECT_EQ(SplitOf({}, sha256), "train");
  }
}

TEST(SplitNames, AreThoseWithAShare) {
  EXPECT_THAT(SplitNames({}), ElementsAre("train"));
  EXPECT_THAT(SplitNames({0, 0.1}), ElementsAre("train", "test"));
  EXPECT_THAT(SplitNames({0.1, 0.1}), ElementsAre("train", "validation", "test"));
}

}  // namespace
}  // namespace duet::client::batch
