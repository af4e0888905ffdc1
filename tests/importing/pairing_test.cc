#include <gmock/gmock.h>

#include "absl/strings/str_cat.h"
#include "model/importing/steps.h"
#include "tests/support/matchers.h"

namespace duet::importing {
namespace {

// "label/name first second source", for each pair.
std::vector<std::string> Lines(const Pairing& pairing) {
  std::vector<std::string> lines;
  for (const PairFiles& pair : pairing.pairs) {
    lines.push_back(absl::StrCat(pair.label, "/", pair.name, " ", pair.first, " ", pair.second,
                                 pair.leader_source.empty() ? "" : " ", pair.leader_source));
  }
  return lines;
}

std::vector<std::string> Refused(const Pairing& pairing) {
  std::vector<std::string> lines;
  for (const Refusal& one : pairing.refused) {
    lines.push_back(absl::StrCat(one.name, ": ", one.reason));
  }
  return lines;
}

TEST(PairByNameTest, TheLastWordDenotesThePerson) {
  const Pairing pairing = PairByName({"Kick_01_B.bvh", "hug-2.follower.csv", "hug-2.leader.csv",
                                      "kick_02_p1.bvh", "kick_02_p2.bvh", "Kick_01_A.bvh"});
  EXPECT_THAT(Lines(pairing), ElementsAre("kick/Kick_01 Kick_01_A.bvh Kick_01_B.bvh",
                                          "hug/hug-2 hug-2.leader.csv hug-2.follower.csv name",
                                          "kick/kick_02 kick_02_p1.bvh kick_02_p2.bvh"));
  EXPECT_THAT(Refused(pairing), IsEmpty());
}

TEST(PairByNameTest, TheFirstFolderIsTheClass) {
  const Pairing pairing =
      PairByName({"Shake Hands/day 1/03_a.bvh", "Shake Hands/day 1/03_b.bvh", "03/take/leader.bvh",
                  "03/take/follower.bvh", "hug/01.npy", "kick_07/a.bvh", "kick_07/b.bvh"});
  EXPECT_THAT(
      Lines(pairing),
      ElementsAre("03/take 03/take/leader.bvh 03/take/follower.bvh name",
                  "shake_hands/day_1_03 Shake Hands/day 1/03_a.bvh Shake Hands/day 1/03_b.bvh",
                  "hug/01 hug/01.npy hug/01.npy", "kick/kick_07 kick_07/a.bvh kick_07/b.bvh"));
}

TEST(PairByNameTest, ReportsEveryUnpairedFile) {
  const Pairing pairing = PairByName(
      {"kick_01_a.bvh", "kick_02_a.bvh", "kick_02_a.csv", "kick_02_b.bvh", "__.npy", "panda.npy"});
  EXPECT_THAT(Lines(pairing), ElementsAre("panda/panda panda.npy panda.npy"));
  EXPECT_THAT(
      Refused(pairing),
      ElementsAre(AllOf(HasSubstr("__.npy"), HasSubstr("class: expected a name CLASS_NUMBER")),
                  "kick_01_a.bvh: other person: expected a file that ends in b, got none",
                  HasSubstr("kick_02_a.bvh: files: expected one for each person of kick_02"),
                  HasSubstr("kick_02_a.csv: files: expected one for each"),
                  HasSubstr("kick_02_b.bvh: files: expected one for each")));
}

TEST(PairByNameTest, EqualNamesGetANumber) {
  EXPECT_THAT(Lines(PairByName({"hug/x y.npy", "hug/x_y.npy"})),
              ElementsAre("hug/x_y hug/x y.npy hug/x y.npy", "hug/x_y_2 hug/x_y.npy hug/x_y.npy"));
}

TEST(PairByTableTest, ReadsAllColumns) {
  const absl::StatusOr<Pairing> pairing = PairByTable(
      "label\tleader\tfollower\tsubjects\tnote\r\n"
      "Big Hug\tx1.bvh\tsub/x2.bvh\tann, bo\tgood\r\n"
      "\n"
      "kick\tboth.npy\t\t\t\n",
      "pairs.tsv", {"both.npy", "sub/x2.bvh", "x1.bvh"});
  ASSERT_THAT(pairing, IsOk());
  EXPECT_THAT(Lines(*pairing), ElementsAre("big_hug/x1 x1.bvh sub/x2.bvh table",
                                           "kick/both both.npy both.npy table"));
  EXPECT_THAT(pairing->pairs[0].subjects, ElementsAre("ann", "bo"));
  EXPECT_THAT(pairing->pairs[1].subjects, IsEmpty());
}

TEST(PairByTableTest, RejectsMissingFiles) {
  const absl::StatusOr<Pairing> pairing =
      PairByTable("leader\tfollower\tlabel\nx1.bvh\tx2.bvh\thug\n", "pairs.tsv", {"x1.bvh"});
  ASSERT_THAT(pairing, IsOk());
  EXPECT_THAT(pairing->pairs, IsEmpty());
  EXPECT_THAT(Refused(*pairing),
              ElementsAre(HasSubstr("x2.bvh: expected a motion file, as pairs.tsv:2 names it")));
}

TEST(PairByTableTest, NamesLineAndColumn) {
  const auto refusal = [](const std::string& table) { return PairByTable(table, "t", {"x"}); };
  EXPECT_THAT(refusal(""),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("t:1: header: expected tab-separated names with leader")));
  EXPECT_THAT(refusal("leader\tfollower\n"), StatusIs(absl::StatusCode::kInvalidArgument,
                                                      HasSubstr("follower, label, got no label")));
  EXPECT_THAT(
      refusal("leader\tfollower\tlabel\nx\tx\n"),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("t:2: columns: expected 3, got 2")));
  EXPECT_THAT(refusal("leader\tfollower\tlabel\nx\tx\t--\n"),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("t:2: label: expected the name of a class, got none")));
}

}  // namespace
}  // namespace duet::importing
