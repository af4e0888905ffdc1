#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "model/dataset/dataset.h"
#include "model/dataset/layout.h"
#include "tests/dataset/capture_folder.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::dataset {
namespace {

// The right person's left hand reaches, everything else stands still.
std::string RightReaches() {
  std::vector<motion::Vec3> left(15), right(15);
  for (motion::Vec3& p : right) p.x = 1;
  std::string text = CaptureLine(1, left, right);
  right[5].y += 0.5f;
  return text + CaptureLine(2, left, right);
}

std::string MessageOf(const CaptureFolder& folder, absl::StatusCode code) {
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  EXPECT_EQ(dataset.status().code(), code) << dataset.status();
  return std::string(dataset.status().message());
}

TEST(ReadDatasetTest, ReadsSbu) {
  CaptureFolder folder;
  folder.Write("s01s02/04/001/skeleton_pos.txt", RightReaches());
  folder.Write("s02s03/08/002/skeleton_pos.txt", StillCapture(4));
  folder.Write("s02s03/01/001/skeleton_pos.txt", "approaching is not read");
  folder.Write("index.tsv", "path\tleader_side\ns02s03/08/002/skeleton_pos.txt\tright\n");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->name, "sbu");
  EXPECT_EQ(dataset->frame_rate_hz, 15);
  EXPECT_THAT(dataset->Subjects(), ElementsAre("s01", "s02", "s03"));
  EXPECT_EQ(dataset->LongestFrameCount(), 4);
  EXPECT_THAT(dataset->symmetric, ElementsAre(false, false, true, true, true, false));
  ASSERT_EQ(dataset->sequences.size(), 2u);

  const Sequence& push = dataset->sequences[0];
  EXPECT_EQ(push.id, "s01s02/04/001/skeleton_pos.txt");
  EXPECT_EQ(dataset->classes[static_cast<size_t>(push.interaction_class)], "push");
  EXPECT_THAT(push.subjects, ElementsAre("s01", "s02"));
  EXPECT_EQ(push.leader_source, "motion");
  // Raw x 1 is 1.28 - 2.56 = -1.28 m; the right person leads.
  EXPECT_FLOAT_EQ(push.pair.leader.at(0, 0).x, -1.28f);
  EXPECT_FLOAT_EQ(push.pair.follower.at(0, 0).x, 1.28f);

  const Sequence& punch = dataset->sequences[1];
  EXPECT_EQ(dataset->classes[static_cast<size_t>(punch.interaction_class)], "punch");
  EXPECT_EQ(punch.leader_source, "index");
  EXPECT_FLOAT_EQ(punch.pair.leader.at(0, 0).z, 128.0f);
  EXPECT_FLOAT_EQ(punch.pair.follower.at(3, 14).z, 14 * 1.28f);
  EXPECT_EQ(punch.pair.follower.frame_count(), 4);
}

TEST(ReadDatasetTest, TellsOnWhichSideTheFollowerStands) {
  // Raw x grows towards world -x. In one file the follower is at the larger raw x, in the other at
  // the smaller; by how much, and how far along the other axes, does not matter.
  CaptureFolder folder;
  std::vector<motion::Vec3> left(15), right(15);
  for (motion::Vec3& p : right) p = {0.25f, 0.1f, 0.75f};
  for (const bool swapped : {false, true}) {
    const std::string file = swapped ? "s02s01" : "s01s02";
    const std::vector<motion::Vec3>& first = swapped ? right : left;
    const std::vector<motion::Vec3>& second = swapped ? left : right;
    folder.Write(file + "/03/001/skeleton_pos.txt",
                 CaptureLine(1, first, second) + CaptureLine(2, first, second));
  }
  folder.Write("index.tsv",
               "path\tleader_side\ns01s02/03/001/skeleton_pos.txt\tleft\n"
               "s02s01/03/001/skeleton_pos.txt\tleft\n");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->sequences[0].partner_direction, (motion::Vec3{-1, 0, 0}));
  EXPECT_EQ(dataset->sequences[1].partner_direction, (motion::Vec3{1, 0, 0}));
}

TEST(ReadDatasetTest, ReadsK3hi) {
  CaptureFolder folder;
  folder.Write("shaking/001.txt", StillCapture(3));
  folder.Write("kicking/001.txt", StillCapture(2));
  folder.Write("kicking/notes.md", "not a capture");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->name, "k3hi");
  EXPECT_EQ(dataset->frame_rate_hz, 30);
  ASSERT_EQ(dataset->sequences.size(), 2u);
  EXPECT_EQ(dataset->classes[static_cast<size_t>(dataset->sequences[0].interaction_class)], "kick");
  EXPECT_EQ(dataset->classes[static_cast<size_t>(dataset->sequences[1].interaction_class)],
            "shake_hands");
  EXPECT_TRUE(dataset->Subjects().empty());
}

constexpr char kOwnLayout[] = R"({
  "name": "own", "frame_rate_hz": 60, "unit": "millimetres", "up_axis": "y-up",
  "skeleton": {"joint_names": ["hips", "left", "right"], "bones": [["hips", "left"], ["hips", "right"]],
               "parts": [{"name": "all", "joints": ["hips", "left", "right"]}],
               "root": "hips", "left_hip": "left", "right_hip": "right",
               "left_foot": "left", "right_foot": "right"},
  "classes": [{"name": "kick"}, {"name": "punch"}]})";

TEST(ReadDatasetTest, ReadsOwnDataWithAnySkeleton) {
  CaptureFolder folder;
  folder.Write("dataset.json", kOwnLayout);
  folder.Write("punch/a.txt",
               "1, 1000,0,0, 2,0,0, 3,0,0, 4,0,0, 5,0,0, 6,0,0\r\n"
               "2, 1000,0,0, 2,0,0, 3,0,0, 4,0,0, 5,0,0, 6000,0,0\r\n\r\n");
  folder.Write("index.tsv", "path\tleader_side\tsubjects\npunch/a.txt\tleft\tann,bob\n");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->name, "own");
  EXPECT_THAT(dataset->classes, ElementsAre("kick", "punch"));
  ASSERT_EQ(dataset->sequences.size(), 1u);
  const Sequence& sequence = dataset->sequences[0];
  EXPECT_EQ(sequence.interaction_class, 1);
  EXPECT_THAT(sequence.subjects, ElementsAre("ann", "bob"));
  EXPECT_FLOAT_EQ(sequence.pair.leader.at(0, 0).x, 1);
  EXPECT_FLOAT_EQ(sequence.pair.follower.at(1, 2).x, 6);
  EXPECT_EQ(sequence.pair.follower.frame_rate_hz, 60);
  EXPECT_FALSE(sequence.partner_direction.has_value());
}

// Two frames at 60 Hz.
constexpr char kTwoFrames[] =
    "1,1,0,0,2,0,0,3,0,0,4,0,0,5,0,0,6,0,0\n2,1,0,0,2,0,0,3,0,0,4,0,0,5,0,0,6,0,0\n";

TEST(ReadDatasetTest, ATimeLineNamesTheSequences) {
  CaptureFolder folder;
  folder.Write("dataset.json", kOwnLayout);
  folder.Write("takes/01.txt", kTwoFrames);
  folder.Write("kick/a.txt", "is not read, because labels.tsv does not name it");
  folder.Write("index.tsv", "path\tleader_side\ntakes/01.txt\tright\n");
  folder.Write("labels.tsv",
               "path\tclass\tfrom_seconds\tto_seconds\n"
               "takes/01.txt\tkick\t0\t0.0167\ntakes/01.txt\tpunch\t0\t0.0333\n");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  ASSERT_EQ(dataset->sequences.size(), 1u);
  const Sequence& take = dataset->sequences[0];
  EXPECT_EQ(take.id, "takes/01.txt");
  EXPECT_EQ(take.interaction_class, 1) << "the longest class";
  ASSERT_EQ(take.labels.size(), 2u);
  EXPECT_EQ(take.labels[1].interaction_class, 1);
  EXPECT_EQ(take.labels[1].end, 2);
}

TEST(ReadDatasetTest, SetsOfDuetBatchAreReadAsTheirLayout) {
  CaptureFolder folder;
  folder.Write("dataset.json", R"({"format": "duet-batch", "format_version": 1})");
  folder.Write("kicking/001.txt", StillCapture(3));
  folder.Write("index.tsv", "path\tleader_side\nkicking/001.txt\tleft\n");
  const absl::StatusOr<Dataset> dataset = ReadDataset(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.status();
  EXPECT_EQ(dataset->name, K3hiLayout().name);
  EXPECT_EQ(dataset->sequences.size(), 1u);
}

TEST(ReadDatasetTest, NamesFileAndLineOfABadCapture) {
  struct Case {
    std::string text;
    const char* message;
  };
  std::string not_finite = StillCapture(3);
  not_finite.replace(not_finite.find("\n2,") + 3, 8, "nan");
  std::string word = StillCapture(3);
  word.replace(word.find("\n3,") + 3, 8, "arm");
  const Case cases[] = {
      {StillCapture(2) + "3,0.5,0.5\n", ":3: expected 91 comma-separated values"},
      {StillCapture(1), "frames: expected at least 2, got 1"},
      {"", "expected at least one line, got none"},
      {not_finite, ":2:3: left person's head x: expected a finite number, got \"nan\""},
      {word, ":3:3: left person's head x: expected a finite number, got \"arm\""},
  };
  for (const Case& one : cases) {
    CaptureFolder folder;
    folder.Write("s01s02/03/001/skeleton_pos.txt", one.text);
    EXPECT_THAT(MessageOf(folder, absl::StatusCode::kInvalidArgument),
                AllOf(HasSubstr("s01s02/03/001/skeleton_pos.txt"), HasSubstr(one.message)));
  }
}

TEST(ReadDatasetTest, RejectsAnIndexThatNamesAnAbsentFile) {
  CaptureFolder folder;
  folder.Write("s01s02/03/001/skeleton_pos.txt", StillCapture(2));
  folder.Write("index.tsv", "path\tleader_side\ns01s02/03/01/skeleton_pos.txt\tleft\n");
  EXPECT_THAT(MessageOf(folder, absl::StatusCode::kInvalidArgument),
              AllOf(HasSubstr("index.tsv:2: "), HasSubstr("path: expected a file below")));
}

TEST(ReadDatasetTest, RejectsAFolderThatIsNoDataSet) {
  CaptureFolder folder;
  EXPECT_THAT(MessageOf(folder, absl::StatusCode::kNotFound), HasSubstr("expected sXXsYY"));
  folder.Write("s01s02/01/001/skeleton_pos.txt", StillCapture(2));
  EXPECT_THAT(MessageOf(folder, absl::StatusCode::kNotFound),
              HasSubstr("expected sequences of the classes of"));
  EXPECT_EQ(ReadDataset(folder.path() / "nowhere").status().code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace duet::dataset
