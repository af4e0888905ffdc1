#include <gmock/gmock.h>

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "model/dataset/dataset.h"
#include "model/importing/import.h"
#include "model/importing/steps.h"
#include "model/solver/body_model.h"
#include "tests/solver/noisy_person.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;
using motion::Poses;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Poses At(Poses person, motion::Vec3 place) {
  for (motion::Vec3& joint : person.all()) joint += place;
  return person;
}

class SolveTest : public ::testing::Test {
 protected:
  SolveTest() {
    layout_.name = "noisy";
    layout_.frame_rate_hz = solver::kRate;
    layout_.skeleton = motion::SbuSkeleton();
    layout_.parts = motion::SbuParts();
    layout_.people_axis = motion::Vec3{0, 0, 1};
    layout_.classes = {{"kick", "kick", false, false, false, {}},
                       {"greet", "greet", true, true, true, {}}};
  }

  // Two people, one of whom stands 6 cm higher.
  ImportedSequence Pair(const std::string& label, const std::string& name, bool noisy) const {
    Poses first = solver::WalkingPerson(3), second = At(first, {0, 0.06f, 1.5f});
    if (noisy) {
      first = solver::WithCameraNoise(first);
      second = solver::WithCameraNoise(second);
    }
    ImportedSequence sequence;
    sequence.capture.files.label = label;
    sequence.capture.files.name = name;
    sequence.capture.files.subjects = {"ann", "bob"};
    sequence.leader_side = dataset::LeaderSide::kRight;
    sequence.leader_source = "table";
    const auto& names = layout_.skeleton.joint_names;
    sequence.capture.first = {names, solver::kRate, first};
    sequence.capture.second = {names, solver::kRate, second};
    return sequence;
  }

  dataset::Dataset SolveAll(const std::vector<ImportedSequence>& sequences) {
    EXPECT_THAT(WriteDataset(from_, layout_, sequences), IsOk());
    EXPECT_THAT(Solve(from_, out_, false, &report_), IsOk());
    absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(out_);
    EXPECT_THAT(dataset, IsOk());
    return dataset.ok() ? *std::move(dataset) : dataset::Dataset{};
  }

  test::TemporaryFolder folder_;
  fs::path from_ = folder_ / "captures", out_ = folder_ / "solved";
  dataset::DatasetLayout layout_;
  SolveReport report_;
};

TEST_F(SolveTest, KeepsEverythingButThePositions) {
  const dataset::Dataset solved =
      SolveAll({Pair("kick", "01", true), Pair("greet", "01", true), Pair("kick", "02", true)});
  EXPECT_EQ(solved.name, "noisy");
  EXPECT_EQ(solved.frame_rate_hz, solver::kRate);
  EXPECT_THAT(solved.classes, ElementsAre("kick", "greet"));
  EXPECT_THAT(solved.symmetric, ElementsAre(false, true));
  EXPECT_THAT(solved.handed, ElementsAre(false, true));
  EXPECT_THAT(solved.touches, ElementsAre(false, true));
  ASSERT_THAT(solved.sequences, SizeIs(3));
  const dataset::Sequence& kick = solved.sequences[1];
  EXPECT_EQ(kick.id, "kick/01.txt");
  EXPECT_THAT(kick.subjects, ElementsAre("ann", "bob"));
  EXPECT_EQ(kick.leader_source, "index");
  // The right person led: 1.5 m ahead of the other.
  ASSERT_TRUE(kick.partner_direction.has_value());
  EXPECT_EQ(kick.partner_direction->z, -1);
  EXPECT_EQ(kick.pair.leader.frame_count(), 46);
}

TEST_F(SolveTest, PeopleOfADepthCameraGetBodiesOnOneFloor) {
  const dataset::Dataset solved = SolveAll({Pair("kick", "01", true)});
  const motion::Clip& leader = solved.sequences[0].pair.leader;
  EXPECT_LT(solver::BodyModel::BoneNoise(solved.skeleton, leader.poses), 0.001);
  EXPECT_GT(report_.moved, 0.01);
  ASSERT_THAT(report_.most_moved, SizeIs(1));
  EXPECT_EQ(report_.most_moved[0].id, "kick/01.txt");
  const auto lowest = [](const Poses& person) {
    float height = 9;
    for (const motion::Vec3& joint : person.all()) height = std::min(height, joint.y);
    return height;
  };
  EXPECT_NEAR(lowest(solved.sequences[0].pair.leader.poses),
              lowest(solved.sequences[0].pair.follower.poses), 0.02);
}

TEST_F(SolveTest, PeopleOfAnOpticalCaptureKeepTheirFloors) {
  const dataset::Dataset solved = SolveAll({Pair("kick", "01", false)});
  EXPECT_LT(report_.moved, 0.02);
  const motion::ClipPair& pair = solved.sequences[0].pair;
  const int head = solved.skeleton.Find("head");
  EXPECT_NEAR(pair.leader.at(0, head).y - pair.follower.at(0, head).y, 0.06, 0.01);
}

TEST_F(SolveTest, KeepsTimeLines) {
  ImportedSequence take = Pair("takes", "01", true);
  take.labels = {{0, 5, 20}, {1, 15, 40}};
  const dataset::Dataset solved = SolveAll({take});
  ASSERT_THAT(solved.sequences, SizeIs(1));
  EXPECT_EQ(solved.sequences[0].id, "takes/01.txt");
  const std::vector<dataset::LabelSpan>& labels = solved.sequences[0].labels;
  ASSERT_THAT(labels, SizeIs(2));
  EXPECT_EQ(labels[0].begin, 5);
  EXPECT_EQ(labels[0].end, 20);
  EXPECT_EQ(labels[1].interaction_class, 1);
  EXPECT_EQ(labels[1].end, 40);
}

TEST_F(SolveTest, ReplacesADataSetOnlyIfAskedTo) {
  SolveAll({Pair("kick", "01", true)});
  EXPECT_THAT(Solve(from_, out_, false, &report_),
              test::StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("--overwrite")));
  EXPECT_THAT(Solve(from_, out_, true, &report_), IsOk());
}

TEST_F(SolveTest, NamesWhatASkeletonLacks) {
  layout_.skeleton.hips.reset();
  layout_.skeleton.feet.reset();
  ASSERT_THAT(WriteDataset(from_, layout_, {Pair("kick", "01", true)}), IsOk());
  EXPECT_THAT(Solve(from_, out_, false, &report_),
              test::StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected hips, feet")));
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace duet::importing
