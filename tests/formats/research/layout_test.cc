#include "model/formats/research/layout.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/flat/npy_array.h"
#include "model/formats/motion_file.h"
#include "model/formats/research/body_joints.h"
#include "model/formats/research/humanml3d_features.h"
#include "model/formats/research/intergen_features.h"
#include "tests/formats/research/npz_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::research {
namespace {

using retargeting::Vec3d;

// The person of TinyBodyJoints, turned by `yaw` about y and moved.
BodyPose Standing(double yaw = 0, Vec3d at = {}) {
  BodyPose pose = test::TinyBodyJoints();
  for (Vec3d& joint : pose) {
    joint = Rotate(retargeting::AxisAngle({0, 1, 0}, yaw), joint) + at;
  }
  return pose;
}

// Walks a curve and turns by two degrees a frame: more than a full turn.
motion::Clip Curve(double rate_hz, int frames = 240) {
  std::vector<BodyPose> poses;
  for (int t = 0; t < frames; ++t) {
    const double yaw = 0.5 + t * M_PI / 90;
    poses.push_back(
        Standing(yaw, {2 + 0.01 * t, 1 + 0.02 * std::sin(0.3 * t), std::sin(0.05 * t)}));
  }
  return ToClip(poses, rate_hz);
}

std::vector<motion::Clip> Parsed(Layout layout, const std::string& npy) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseNpyOf(layout, npy, "a.npy");
  EXPECT_TRUE(motion.ok()) << motion.status();
  return motion.ok() ? motion->people : std::vector<motion::Clip>{};
}

std::string ParseError(Layout layout, const std::string& npy) {
  return std::string(ParseNpyOf(layout, npy, "a.npy").status().message());
}

class EveryLayout : public ::testing::TestWithParam<Layout> {};

TEST_P(EveryLayout, ReadsBackWhatItKeeps) {
  const Layout layout = GetParam();
  std::vector<motion::Clip> people = {Curve(FrameRateOf(layout))};
  if (layout != Layout::kHumanMl3dFeatures) {
    people.push_back(people[0]);
    for (motion::Vec3& position : people[1].poses.all()) position += {0.3f, 0.1f, 1};
  }
  const std::vector<motion::Clip> read = Parsed(layout, FormatNpyOf(layout, people));
  const std::vector<motion::Clip> kept = KeptBy(layout, people);
  ASSERT_EQ(read.size(), people.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].frame_count(), kept[i].frame_count());
    EXPECT_LT(test::LargestDistance(read[i], kept[i]), 2e-4f);
  }
}

TEST_P(EveryLayout, HasANameThatIsParsed) {
  EXPECT_EQ(ParseLayout(LayoutName(GetParam())), GetParam());
  EXPECT_THAT(kLayoutNames, HasSubstr(std::string(LayoutName(GetParam()))));
}

INSTANTIATE_TEST_SUITE_P(Layouts, EveryLayout,
                         ::testing::Values(Layout::kHumanMl3d, Layout::kHumanMl3dFeatures,
                                           Layout::kInterGen, Layout::kInterGenFeatures,
                                           Layout::kInterX),
                         [](const auto& instance) {
                           return "Layout" + std::to_string(static_cast<int>(instance.param));
                         });

// What features keep is the motion itself, moved and turned as a whole.
TEST(Layout, FeaturesKeepEveryDistance) {
  const motion::Clip person = Curve(20);
  for (const Layout layout : {Layout::kHumanMl3dFeatures, Layout::kInterGenFeatures}) {
    const motion::Clip kept = KeptBy(layout, {person})[0];
    ASSERT_EQ(kept.frame_count(), person.frame_count() - 1);
    for (int t = 0; t < kept.frame_count(); ++t) {
      for (int joint = 0; joint < kBodyJoints; ++joint) {
        EXPECT_NEAR(Distance(kept.at(t, joint), kept.at(0, kLeftWrist)),
                    Distance(person.at(t, joint), person.at(0, kLeftWrist)), 1e-5f);
      }
    }
    EXPECT_NEAR(kept.at(0, kPelvis).x, 0, 1e-5f);
    EXPECT_NEAR(kept.at(0, kPelvis).z, 0, 1e-5f);
    EXPECT_GT(kept.at(0, kLeftHip).x - kept.at(0, kRightHip).x, 0.19f);  // faces z
  }
}

TEST(HumanMl3d, AStandingPersonHasTheFeaturesOfItsPose) {
  const std::vector<BodyPose> poses = {Standing(0.7, {3, 4, 5}), Standing(0.7, {3, 4, 5})};
  const std::vector<float> row = HumanMl3dFeatures(poses);
  ASSERT_EQ(row.size(), 263u);
  EXPECT_NEAR(row[0], 0, 1e-6f);
  EXPECT_NEAR(row[1], 0, 1e-6f);
  EXPECT_NEAR(row[2], 0, 1e-6f);
  EXPECT_NEAR(row[3], 0.95f, 1e-6f);  // the balls of the feet are at -0.85, the pelvis at 0.1
  const auto local = [&row](int joint) {
    const std::size_t at = 4 + 3 * static_cast<std::size_t>(joint - 1);
    return motion::Vec3{row[at], row[at + 1], row[at + 2]};
  };
  EXPECT_LT(Distance(local(kLeftHip), {0.1f, 0.85f, 0}), 1e-5f);
  EXPECT_LT(Distance(local(kRightWrist), {-0.75f, 1.35f, 0}), 1e-5f);
  EXPECT_LT(Distance(local(kLeftFoot), {0.1f, 0, 0.1f}), 1e-5f);
  const auto rotation = [&row](int joint) {
    const auto at = row.begin() + 67 + 6 * (joint - 1);
    return std::vector<float>(at, at + 6);
  };
  const auto is = [](std::vector<float> expected) {
    return ::testing::Pointwise(::testing::FloatNear(1e-5f), expected);
  };
  EXPECT_THAT(rotation(kSpine1), is({1, 0, 0, 0, 1, 0}));
  // About z: the collar turns by atan(0.1 / 0.08) from x, and the shoulder from there to a quarter
  // turn from -y to x. The rest of the arm is straight.
  const float length = std::hypot(0.08f, 0.1f), c = 0.1f / length, s = 0.08f / length;
  EXPECT_THAT(rotation(kLeftCollar), is({s, c, 0, -c, s, 0}));
  EXPECT_THAT(rotation(kLeftShoulder), is({c, s, 0, -s, c, 0}));
  EXPECT_THAT(rotation(kLeftElbow), is({1, 0, 0, 0, 1, 0}));
  for (std::size_t i = 193; i < 259; ++i) EXPECT_NEAR(row[i], 0, 1e-6f) << i;
  EXPECT_THAT(std::vector<float>(row.begin() + 259, row.end()), ElementsAre(1, 1, 1, 1));
}

TEST(HumanMl3d, TheTurnIsHalfTheAngleAndTheWayIsInTheNewHeading) {
  std::vector<BodyPose> poses;
  for (int t = 0; t < 400; ++t) poses.push_back(Standing(0.02 * t, {0.1 * t, 0, 0}));
  const std::vector<float> rows = HumanMl3dFeatures(poses);
  // Far from both ends, the filtered heading is the person's.
  for (int t = 100; t < 280; ++t) {
    const float* row = rows.data() + 263 * t;
    const double yaw = 0.02 * (t + 1);
    EXPECT_NEAR(row[0], -0.01, 1e-4) << t;
    EXPECT_NEAR(row[1], 0.1 * std::cos(yaw), 1e-3) << t;
    EXPECT_NEAR(row[2], 0.1 * std::sin(yaw), 1e-3) << t;
  }
}

TEST(InterGen, ATPoseHasNoRotations) {
  const std::vector<float> row =
      InterGenFeatures(AtInterGenStart({{Standing(2, {1, 2, 3}), Standing(2, {1, 2, 3})}})[0]);
  ASSERT_EQ(row.size(), 262u);
  EXPECT_NEAR(row[1], 0.95f, 1e-6f);
  EXPECT_NEAR(row[3 * kLeftWrist], 0.75f, 1e-5f);
  for (std::size_t i = 66; i < 132; ++i) EXPECT_NEAR(row[i], 0, 1e-6f);
  for (const int joint : {kSpine1, kLeftElbow, kRightWrist, kLeftKnee}) {
    const auto at = row.begin() + 132 + 6 * (joint - 1);
    EXPECT_THAT(std::vector<float>(at, at + 6),
                ::testing::Pointwise(::testing::FloatNear(0.2f), {1.f, 0.f, 0.f, 1.f, 0.f, 0.f}))
        << joint;
  }
  // Ankles at 0.05 m, balls of the feet on the floor.
  EXPECT_THAT(std::vector<float>(row.begin() + 258, row.end()), ElementsAre(1, 1, 1, 1));
}

TEST(InterGen, ARaisedFootDoesNotStay) {
  BodyPose pose = Standing();
  pose[kLeftFoot].y += 0.1;
  pose[kLeftAnkle].y += 0.1;
  BodyPose next = pose;
  next[kRightAnkle].z += 0.04;  // its square is more than 0.001
  const std::vector<float> row = InterGenFeatures(AtInterGenStart({{pose, next}})[0]);
  EXPECT_THAT(std::vector<float>(row.begin() + 258, row.end()), ElementsAre(0, 0, 0, 1));
}

TEST(InterGen, TheSecondPersonKeepsItsPlaceRelativeToTheFirst) {
  const std::vector<BodyPose> first = {Standing(M_PI / 2, {1, 0, 1})};
  const std::vector<BodyPose> second = {Standing(-M_PI / 2, {3, 7, 1})};
  const auto placed = AtInterGenStart({first, second});
  EXPECT_NEAR(Norm(placed[0][0][kPelvis] - Vec3d{0, 0.95, 0}), 0, 1e-9);
  EXPECT_NEAR(Norm(placed[1][0][kPelvis] - Vec3d{0, 0.95, 2}), 0, 1e-9);      // ahead, on the floor
  EXPECT_NEAR(Norm(placed[1][0][kLeftHip] - Vec3d{-0.1, 0.85, 2}), 0, 1e-9);  // faces the first
}

TEST(Layout, ReadsTheShapesOfTheDataSets) {
  const motion::Clip person = Curve(30, 3);
  std::vector<float> flat(person.poses.all().size() * 3);
  std::memcpy(flat.data(), person.poses.all().data(), flat.size() * sizeof(float));
  EXPECT_EQ(Parsed(Layout::kHumanMl3d, test::Array({3, 66}, flat))[0].poses, person.poses);
  // SMPL+H: the first 22 of 52 joints.
  std::vector<float> hands(3 * 52 * 3);
  for (std::size_t t = 0; t < 3; ++t) {
    std::copy_n(flat.begin() + static_cast<int>(66 * t), 66,
                hands.begin() + static_cast<int>(156 * t));
  }
  EXPECT_EQ(Parsed(Layout::kHumanMl3d, test::Array({3, 52, 3}, hands))[0].poses, person.poses);
  // InterHuman: z up, so the pelvis' height is the third number.
  std::vector<float> row(492);
  row[2] = 1;
  const std::string interhuman = test::Array({1, 492}, row);
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseNpyOf(Layout::kInterGen, interhuman, "a.npy");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kZUp);
  EXPECT_EQ(motion->people[0].at(0, kPelvis), (motion::Vec3{0, 0, 1}));
  // Two people side by side in a row.
  std::vector<float> both(2 * 524);
  both[524 + 262] = 5;
  const std::vector<motion::Clip> people =
      Parsed(Layout::kInterGenFeatures, test::Array({2, 524}, both));
  ASSERT_EQ(people.size(), 2u);
  EXPECT_EQ(people[0].at(1, kPelvis).x, 0);
  EXPECT_EQ(people[1].at(1, kPelvis).x, 5);
}

TEST(Layout, GuessesOnlyWidthsThatNoOtherArrayHas) {
  const auto guess = [](const std::vector<int>& shape) {
    std::size_t count = 1;
    for (const int size : shape) count *= static_cast<std::size_t>(size);
    std::string why;
    return GuessLayout(test::Array(shape, std::vector<float>(count)), &why);
  };
  EXPECT_EQ(guess({4, 263}), Layout::kHumanMl3dFeatures);
  EXPECT_EQ(guess({4, 262}), Layout::kInterGenFeatures);
  EXPECT_EQ(guess({2, 4, 262}), Layout::kInterGenFeatures);
  EXPECT_EQ(guess({4, 524}), Layout::kInterGenFeatures);
  EXPECT_EQ(guess({4, 492}), Layout::kInterGen);
  EXPECT_EQ(guess({4, 22, 3}), std::nullopt);
  EXPECT_EQ(guess({4, 66}), std::nullopt);
  EXPECT_EQ(guess({263}), std::nullopt);
}

TEST(Layout, RejectsOtherShapesAndNumbers) {
  const auto zeros = [](int count) { return std::vector<float>(static_cast<std::size_t>(count)); };
  EXPECT_THAT(ParseError(Layout::kHumanMl3d, test::Array({1, 64, 3}, zeros(192))),
              HasSubstr("shape: expected (frames, 22, 3) or (2, frames, 22, 3) for layout "
                        "humanml3d, got (1, 64, 3)"));
  EXPECT_THAT(ParseError(Layout::kHumanMl3dFeatures, test::Array({2, 1, 263}, zeros(526))),
              HasSubstr("expected (frames, 263) for layout humanml3d-263, got (2, 1, 263)"));
  EXPECT_THAT(ParseError(Layout::kInterGenFeatures, test::Array({0, 262}, {})),
              HasSubstr("expected 1 to 200000 frames, got 0"));
  std::vector<float> row = zeros(263);
  row[5] = NAN;
  EXPECT_THAT(ParseError(Layout::kHumanMl3dFeatures, test::Array({1, 263}, row)),
              HasSubstr("frame 0: expected finite numbers, got nan"));
}

TEST(Layout, WritingPlacesJointsAndResamples) {
  std::vector<std::string> notes;
  const absl::StatusOr<std::vector<motion::Clip>> bodies =
      ToLayout(Layout::kHumanMl3d, {test::MakePerson()}, &notes);
  ASSERT_TRUE(bodies.ok()) << bodies.status();
  EXPECT_EQ((*bodies)[0].frame_rate_hz, 20);
  EXPECT_EQ((*bodies)[0].frame_count(), 41);  // the whole duration
  EXPECT_THAT(notes, ElementsAre(HasSubstr("resampled from 30 Hz to the 20 Hz of layout humanml3d"),
                                 HasSubstr("joints placed, which the motion does not have: pelvis, "
                                           "spine1")));
  EXPECT_FALSE(ToLayout(Layout::kHumanMl3dFeatures, {Curve(20), Curve(20)}, nullptr).ok());
  EXPECT_FALSE(ToLayout(Layout::kInterGenFeatures, {Curve(30, 1)}, nullptr).ok());
  motion::Clip headless = test::MakePerson();
  headless.joint_names[0] = "other";
  EXPECT_THAT(std::string(ToLayout(Layout::kHumanMl3d, {headless}, nullptr).status().message()),
              HasSubstr("joints: expected head, got only other, neck"));
}

TEST(BodyJoints, ThePlacedJointsAreWhereAPersonHasThem) {
  motion::Clip person = test::MakePerson({1});
  const absl::StatusOr<motion::Clip> body = ToBody(person, nullptr);
  ASSERT_TRUE(body.ok()) << body.status();
  const auto at = [&body](int joint) { return body->at(0, joint); };
  const auto of = [&person](const char* name) {
    return person.at(0, motion::SbuSkeleton().Find(name));
  };
  EXPECT_EQ(at(kLeftAnkle), of("left_foot"));
  EXPECT_EQ(at(kRightWrist), of("right_hand"));
  EXPECT_GT(at(kPelvis).y, at(kLeftHip).y);
  EXPECT_GT(at(kSpine1).y, at(kPelvis).y);
  EXPECT_GT(at(kSpine2).y, at(kSpine1).y);
  EXPECT_GT(at(kSpine3).y, at(kSpine2).y);
  EXPECT_GT(at(kNeck).y, at(kSpine3).y);
  EXPECT_GT(at(kHead).y, at(kNeck).y);
  EXPECT_NEAR(Distance(at(kLeftFoot), at(kLeftAnkle)), std::hypot(0.13f, 0.06f), 1e-4f);
  EXPECT_GT(at(kLeftFoot).z, at(kLeftAnkle).z);  // the person faces z
  EXPECT_EQ(ToBody(*body, nullptr)->poses, body->poses);
}

// Through the front door, as every program reads and writes.
TEST(Layout, TheFrontDoorReadsAndWritesLayouts) {
  const motion::Clip person = Curve(20);
  WriteOptions writing;
  writing.layout = Layout::kHumanMl3dFeatures;
  const absl::StatusOr<std::string> npy =
      FormatPeople(Format::kNpy, {person}, BodySkeleton(), writing);
  ASSERT_TRUE(npy.ok()) << npy.status();
  retargeting::ReadingReport report;
  ReadOptions reading;
  reading.format = Format::kNpy;
  reading.skeleton = BodySkeleton();
  reading.report = &report;
  const absl::StatusOr<motion::Clip> read = ParseLeader(*npy, "a.npy", reading);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->frame_rate_hz, 20);
  EXPECT_LT(test::LargestDistance(*read, KeptBy(*writing.layout, {person})[0]), 2e-4f);
  EXPECT_EQ(report.layout->value, "humanml3d-263");
  EXPECT_EQ(report.layout->origin, retargeting::Origin::kGuessed);
  EXPECT_EQ(report.frame_rate->origin, retargeting::Origin::kDefault);
  writing.layout = Layout::kHumanMl3d;
  const absl::StatusOr<std::string> positions =
      FormatPeople(Format::kNpy, {person}, BodySkeleton(), writing);
  ReadOptions fifteen;
  fifteen.format = Format::kNpy;
  EXPECT_THAT(std::string(ParseLeader(*positions, "a.npy", fifteen).status().message()),
              HasSubstr("for an array of research, specify its layout (humanml3d"));
  fifteen.layout = Layout::kHumanMl3d;
  const absl::StatusOr<motion::Clip> mapped = ParseLeader(*positions, "a.npy", fifteen);
  ASSERT_TRUE(mapped.ok()) << mapped.status();
  EXPECT_EQ(mapped->at(5, motion::SbuSkeleton().Find("left_hand")), person.at(5, kLeftWrist));
}

}  // namespace
}  // namespace duet::formats::research
