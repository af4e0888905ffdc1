#include "client/batch/leaders.h"

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using ::testing::_;

// All that a source gives; the status of the first that it cannot.
absl::StatusOr<std::vector<LeaderEntry>> ReadAll(LeaderSource& source) {
  std::vector<LeaderEntry> entries;
  while (true) {
    absl::StatusOr<std::optional<LeaderEntry>> entry = source.Next();
    if (!entry.ok()) return entry.status();
    if (!entry->has_value()) return entries;
    entries.push_back(**std::move(entry));
  }
}

absl::StatusOr<std::vector<LeaderEntry>> ReadText(const std::string& text) {
  return ReadAll(*ReadManifest(std::make_unique<std::istringstream>(text), "/data", "m"));
}

std::vector<std::string> Keys(const std::vector<LeaderEntry>& entries) {
  std::vector<std::string> keys;
  for (const LeaderEntry& entry : entries) keys.push_back(entry.key);
  return keys;
}

TEST(Manifest, ReadsTsvByItsHeader) {
  const auto entries = ReadText(
      "\xEF\xBB\xBFleader_side\tleader\tlabels\tmood\tseed\tpartner_direction\tfollower_start\r\n"
      "right\twalks/a.bvh\thug=0.5,kick=1\tcalm\t7\t1,0,0\tstart.csv\n"
      "\t/b.csv\t\t\t\t\t0,1,2\n");
  ASSERT_THAT(entries, IsOk());
  ASSERT_EQ(entries->size(), 2u);
  const LeaderEntry& first = (*entries)[0];
  EXPECT_EQ(first.given, "walks/a.bvh");
  EXPECT_EQ(first.file, "/data/walks/a.bvh");
  EXPECT_EQ(first.side, formats::Side::kRight);
  ASSERT_EQ(first.labels.size(), 2u);
  EXPECT_EQ(first.labels[1].interaction_class, "kick");
  EXPECT_EQ(first.seed, 7u);
  EXPECT_EQ(first.partner_direction->x, 1);
  EXPECT_EQ(first.follower_start, "/data/start.csv");
  EXPECT_THAT(first.extra, ElementsAre(Pair("mood", "calm")));
  EXPECT_THAT(Keys(*entries), ElementsAre("walks/a-2", "b-3"));
  EXPECT_EQ((*entries)[1].file, "/b.csv");
  EXPECT_EQ((*entries)[1].follower_start, "0,1,2");
  EXPECT_TRUE((*entries)[1].extra.empty());
  EXPECT_THAT(Keys(*ReadText("leader\tid\na.bvh\tx/y.1\n\nb.bvh\tz\n")), ElementsAre("x/y_1", "z"));
}

struct BadManifest {
  const char* text;
  const char* message;
};
class BadManifests : public ::testing::TestWithParam<BadManifest> {};

TEST_P(BadManifests, AreRefusedByLine) {
  EXPECT_THAT(ReadText(GetParam().text),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadManifests,
    ::testing::Values(
        BadManifest{"leader\tleader_side\na.bvh\n",
                    "m:2: columns: expected 2 as the first line names, got 1"},
        BadManifest{"leader\tleader_side\na.bvh\tup\n",
                    "m:2: leader_side: expected left or right, got \"up\""},
        BadManifest{"side\nleft\n", "m:1: columns: expected leader among the names"},
        BadManifest{"leader\tside\n\tleft\n", "m:2: leader: expected a motion file, got nothing"},
        BadManifest{"leder\tid\n", "of the first line, got \"leder\\tid\""},
        BadManifest{"leader\tseed\na.bvh\t-1\n", "from 0 to 18446744073709551615, got \"-1\""},
        BadManifest{"leader\tlabels\na.bvh\tkick\n", "m:2: labels: expected CLASS=WEIGHT"},
        BadManifest{"leader\tlabels\na.bvh\tkick=1,kick=0\n", "each class once"},
        BadManifest{"leader\tlabels\na.bvh\tkick=2.5\n", "from -2 to 2, got \"kick=2.5\""},
        BadManifest{"leader\tpartner_direction\na.bvh\t1\n", "partner_direction: expected X,Y,Z"},
        BadManifest{"leader\tid\na.bvh\tx\nb.bvh\tx\n",
                    "m:3: id: expected one that no other line has, got \"x\""},
        BadManifest{"leader\tid\na.bvh\t..\n",
                    "m:2: id: expected a name, or names separated by /, other than . and .., got "
                    "\"..\""},
        BadManifest{"leader\tid\na.bvh\tx\nb.bvh\t\n",
                    "m:3: id: expected one, as on the lines before, got nothing"}));

class ListLeadersTest : public ::testing::Test {
 protected:
  ListLeadersTest() {
    for (const char* name :
         {"walks/b.bvh", "walks/a.csv", "walks/a.bvh", "walks/notes.md", "c.npy"}) {
      std::filesystem::create_directories((folder_ / name).parent_path());
      test::WriteTestFile(folder_ / name, "");
    }
  }
  absl::StatusOr<std::vector<std::string>> List(const std::vector<std::string>& names) {
    std::vector<std::string> inputs;
    for (const std::string& name : names) inputs.push_back((folder_ / name).string());
    auto source = ListLeaders(inputs);
    if (!source.ok()) return source.status();
    const auto entries = ReadAll(**source);
    if (!entries.ok()) return entries.status();
    return Keys(*entries);
  }
  test::TemporaryFolder folder_;
};

TEST_F(ListLeadersTest, FoldersAreMirroredByName) {
  const auto keys = List({"."});
  ASSERT_THAT(keys, IsOk());
  // Two formats of one name: the second has its ending as well.
  EXPECT_THAT(*keys, ElementsAre("c", "walks/a", "walks/a_csv", "walks/b"));
}

TEST_F(ListLeadersTest, TextAndJsonOfAFolderAreSkipped) {
  for (const char* name : {"texts/walk.txt", "texts/motion.JSON", "texts/step.bvh"}) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    test::WriteTestFile(folder_ / name, "");
  }
  EXPECT_THAT(*List({"texts"}), ElementsAre("step"));
  // Somebody who names a file means it.
  EXPECT_THAT(*List({"texts/walk.txt"}), ElementsAre("walk"));
}

TEST_F(ListLeadersTest, MissingPathIsRejected) {
  EXPECT_THAT(List({"none.bvh"}), StatusIs(absl::StatusCode::kNotFound, HasSubstr("none.bvh")));
  EXPECT_THAT(List({"walks/notes.md"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("notes.md")));
  EXPECT_THAT(List({"c.npy", "c.npy", "c.npy"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected a unique one")));
  EXPECT_THAT(ListLeaders({}), StatusIs(absl::StatusCode::kInvalidArgument,
                                        HasSubstr("expected one or more motion files")));
}

TEST_F(ListLeadersTest, ADataSetAmongItsLeadersIsRejected) {
  const auto check = [&](const std::string& input, const std::filesystem::path& out) {
    return CheckInputs({(folder_ / "c.npy").string(), (folder_ / input).string()}, out);
  };
  for (const char* out : {"walks", "walks/", "walks/set", "walks/not/yet", "set/../walks/x"}) {
    EXPECT_THAT(check("walks", folder_ / out),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--out: expected a folder")))
        << out;
  }
  std::filesystem::create_directory_symlink(folder_ / "walks", folder_ / "link");
  EXPECT_THAT(check("link", folder_ / "walks/set"),
              StatusIs(absl::StatusCode::kInvalidArgument, _));
  EXPECT_THAT(check("walks", folder_ / "set"), IsOk());
  EXPECT_THAT(check("walks", folder_ / "walks2"), IsOk());
  EXPECT_THAT(check("walks", folder_.path()), IsOk());
  EXPECT_THAT(check("walks/a.bvh", folder_ / "walks"), IsOk());
  EXPECT_THAT(check("wlaks", folder_ / "set"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("wlaks")));
}

TEST(KeyOf, IsValidInFileSystemsAndArchives) {
  EXPECT_EQ(KeyOf("../walks/./Kick 1.v2"), "walks/Kick_1_v2");
  EXPECT_EQ(KeyOf("/abs/a:b+c-d_e"), "abs/a_b+c-d_e");
  // Letters of other scripts stay, and bytes that are no UTF-8 go.
  EXPECT_EQ(KeyOf("caf\xc3\xa9/\xe6\xad\xa9/\xf0\x9f\x92\x83"),
            "caf\xc3\xa9/\xe6\xad\xa9/\xf0\x9f\x92\x83");
  EXPECT_EQ(KeyOf("caf\xe9"), "caf_");
  EXPECT_EQ(KeyOf("\xc0\xaf"), "__");            // longer than needed
  EXPECT_EQ(KeyOf("\xed\xa0\x80"), "___");       // half of a UTF-16 pair
  EXPECT_EQ(KeyOf("\xf4\x90\x80\x80"), "____");  // beyond the last character
  EXPECT_EQ(KeyOf("\xe6\xad"), "_");             // cut short
}

}  // namespace
}  // namespace duet::client::batch
