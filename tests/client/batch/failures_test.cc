#include "client/batch/failures.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

nlohmann::ordered_json Failed(const char* leader, const char* name, const std::string& message) {
  return {{"state", "failed"},
          {"name", name},
          {"leader", leader},
          {"error", {{"code", "NOT_FOUND"}, {"message", message}}}};
}

auto Cause(const std::string& message, int64_t items, int64_t leaders) {
  return AllOf(Field(&FailureCause::message, message), Field(&FailureCause::items, items),
               Field(&FailureCause::leaders, leaders));
}

TEST(FailureTable, HasARowForEachLeaderAndCause) {
  const test::TemporaryFolder folder;
  JobFolder set(folder.path());
  JobIdentity begun;
  ASSERT_THAT(set.Open({}, &begun), IsOk());
  FailureTable table(set);
  ASSERT_THAT(table.Open(), IsOk());
  for (const char* name : {"a-kick", "a-hug"}) {
    ASSERT_THAT(table.Add(Failed("a.bvh", name, "walks/a.bvh: no such file")), IsOk());
  }
  ASSERT_THAT(table.Add(Failed("a.bvh", "a-push", "no\tpushes\n")), IsOk());
  ASSERT_THAT(table.Add(Failed("b.bvh", "b-kick", "walks/b.bvh: no such file")), IsOk());
  ASSERT_THAT(table.Finish(), IsOk());
  EXPECT_EQ(test::ReadTestFile(folder / "failed.tsv"),
            "leader\titems\tcode\tmessage\tnames\n"
            "a.bvh\t1\tNOT_FOUND\tno pushes \ta-push\n"
            "a.bvh\t2\tNOT_FOUND\twalks/a.bvh: no such file\ta-kick,a-hug\n"
            "b.bvh\t1\tNOT_FOUND\twalks/b.bvh: no such file\tb-kick\n");
  EXPECT_EQ(table.leaders(), 2);
  // The file is no part of the cause.
  EXPECT_THAT(table.causes().Largest(9),
              ElementsAre(Cause("no such file", 3, 2), Cause("no\tpushes\n", 1, 1)));
}

TEST(AllowedFailures, AreANumberOrAShareOfLeaders) {
  EXPECT_TRUE(AllowedFailures().Allows(0, 0));
  EXPECT_FALSE(AllowedFailures().Allows(1, 1000));
  const auto five = ParseAllowedFailures("5");
  ASSERT_THAT(five, IsOk());
  EXPECT_TRUE(five->Allows(5, 5));
  EXPECT_FALSE(five->Allows(6, 1000));
  const auto share = ParseAllowedFailures("2%");
  ASSERT_THAT(share, IsOk());
  EXPECT_TRUE(share->Allows(5, 270));
  EXPECT_FALSE(share->Allows(6, 270));
  EXPECT_TRUE(ParseAllowedFailures("0.5%")->Allows(1, 200));
}

TEST(AllowedFailures, OtherTextsAreRejected) {
  for (const char* text : {"", "%", "-1", "1.5", "-1%", "101%", "nan%", "5 %x", "five"}) {
    EXPECT_THAT(ParseAllowedFailures(text),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         HasSubstr("expected a number of leaders, or a share of them from 0% to "
                                   "100%, got \"")))
        << text;
  }
}

TEST(FailureCauses, OnlyTheLeadersOwnFileIsOmitted) {
  FailureCauses causes;
  causes.Add("a.bvh", "X", "a.bvh:12:3: expected a number, got \"x\"", 1, 1);
  causes.Add("a.bvh", "X", "other: a.bvh: is named", 2, 1);
  EXPECT_THAT(causes.Largest(2), ElementsAre(Cause("other: a.bvh: is named", 2, 1),
                                             Cause("12:3: expected a number, got \"x\"", 1, 1)));
}

TEST(FailureCauses, NumberOfCausesIsLimited) {
  FailureCauses causes;
  for (int i = 0; i < 5000; ++i) causes.Add("", "X", std::to_string(i), 1, 1);
  const auto largest = causes.Largest(10000);
  EXPECT_THAT(largest, SizeIs(1001));
  EXPECT_THAT(largest[0], Cause("other causes", 4000, 4000));
}

}  // namespace
}  // namespace duet::client::batch
