#include "client/batch/set_item.h"

#include <string>

#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "model/formats/flat/sbu_text.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

class SetItemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    motion::ClipPair pair;
    pair.leader.joint_names = motion::SbuSkeleton().joint_names;
    pair.leader.frame_rate_hz = 15;
    pair.leader.poses = test::SwayingMotion(9, 15);
    pair.follower = pair.leader;
    const auto text = formats::flat::FormatSbu({pair.leader, pair.follower});
    ASSERT_THAT(text, IsOk());
    content_ = *text;
    record_ = {{"item", 4},
               {"id", "00"},
               {"state", "done"},
               {"name", "walks/a-hug"},
               {"side", "left"},
               {"labels", {{"hug", 0.5}}},
               {"model", "m@1"},
               {"frames", 9},
               {"frame_rate_hz", 15},
               {"skeleton", 0},
               {"quality", ordered_json::object()},
               {"files",
                {{{"path", "walks/a-hug.txt"},
                  {"bytes", content_.size()},
                  {"sha256", base::Sha256Hex(content_)}}}}};
    const motion::Skeleton skeleton = motion::SbuSkeleton();
    Describe({{"joint_names", skeleton.joint_names},
              {"parents", skeleton.Parents()},
              {"root_joint", "torso"}});
    WriteIndex();
  }

  void Describe(const ordered_json& skeleton) {
    test::WriteTestFile(set_ / "dataset.json", ordered_json({{"skeletons", {skeleton}}}).dump());
  }
  void WriteIndex() {
    ordered_json other = record_;
    other["name"] = "walks/a-hug-2";
    other["item"] = 3;
    other["files"][0]["path"] = "walks/a-hug-2.txt";
    test::WriteTestFile(set_ / "index.jsonl", other.dump() + "\n" + record_.dump() + "\n");
  }
  void WriteFile() {
    std::filesystem::create_directories(set_ / "walks");
    test::WriteTestFile(set_ / "walks/a-hug.txt", content_);
  }

  test::TemporaryFolder set_;
  std::string content_;
  ordered_json record_;
};

TEST_F(SetItemTest, IsFoundByNameNumberAndFile) {
  EXPECT_TRUE(IsSet(set_.path()));
  WriteFile();
  for (const char* item : {"walks/a-hug", "4", "walks/a-hug.txt"}) {
    const auto read = ReadSetItem(set_.path(), item);
    ASSERT_THAT(read, IsOk()) << item;
    EXPECT_EQ(read->record["item"], 4);
    EXPECT_EQ(read->pair.follower.poses.frame_count(), 9);
    EXPECT_EQ(read->skeleton.bones.size(), 14u);
  }
}

TEST_F(SetItemTest, IsReadFromItsShard) {
  record_["shard"] = "set-000000.tar";
  WriteIndex();
  DurableFile file(set_ / "partial");
  ASSERT_THAT(file.Open(), IsOk());
  const auto archive = MakeArchive(Packing::kTar, &file);
  ASSERT_THAT(archive->Add("walks/a-hug.txt", content_), IsOk());
  ASSERT_THAT(archive->Finish(), IsOk());
  ASSERT_THAT(file.Finish(set_ / "set-000000.tar"), IsOk());
  EXPECT_THAT(ReadSetItem(set_.path(), "4"), IsOk());
}

TEST_F(SetItemTest, ErrorsNameWhatIsMissingOrChanged) {
  EXPECT_THAT(ReadSetItem(set_.path(), "hug"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("item: expected the name or the")));
  EXPECT_THAT(ReadSetItem(set_.path(), "4"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("walks/a-hug.txt")));
  WriteFile();
  test::WriteTestFile(set_ / "walks/a-hug.txt", "changed");
  EXPECT_THAT(ReadSetItem(set_.path(), "4"),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("was changed")));
}

TEST_F(SetItemTest, ForeignDescriptionsAreRejected) {
  WriteFile();
  const auto names = motion::SbuSkeleton().joint_names;
  for (const ordered_json& skeleton :
       {ordered_json(3), ordered_json({{"joint_names", names}}),
        ordered_json({{"joint_names", names}, {"parents", {99, "x"}}, {"root_joint", "torso"}}),
        ordered_json({{"joint_names", names}, {"parents", {-1}}, {"root_joint", "tail"}})}) {
    Describe(skeleton);
    EXPECT_THAT(ReadSetItem(set_.path(), "4"),
                StatusIs(absl::StatusCode::kDataLoss, HasSubstr("dataset.json")))
        << skeleton;
  }
  test::WriteTestFile(set_ / "dataset.json", "{}");
  EXPECT_THAT(ReadSetItem(set_.path(), "4"),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("skeletons: expected one")));
}

TEST(WeightsOf, KeyframesKeepTheirFrames) {
  const auto constant = WeightsOf({{"labels", {{"hug", 0.5}}}});
  ASSERT_THAT(constant, SizeIs(1));
  EXPECT_EQ(constant[0].weights[0].interaction_class, "hug");
  const auto changing = WeightsOf(
      {{"keyframes",
        {{{"frame", 0}, {"labels", {{"hug", 1}}}}, {{"frame", 7}, {"labels", {{"kick", 1}}}}}}});
  ASSERT_THAT(changing, SizeIs(2));
  EXPECT_EQ(changing[1].frame, 7);
  EXPECT_EQ(changing[1].weights[0].interaction_class, "kick");
}

}  // namespace
}  // namespace duet::client::batch
