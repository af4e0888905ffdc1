// Rigs whose offsets make no standing person, as those of LAFAN1 and Kimodo: each bone points along
// the x axis of its joint at rest, and only the motion makes a person.
#include <cstddef>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/bvh/bvh_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::bvh {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr float kOneMillimetre = 0.001f, kThreeCentimetres = 0.03f;

// A rig and its motion.
struct Flat {
  BvhDocument document;
  std::vector<BvhTrack> tracks;  // [joints]
};

// The motion of `standing` on a rig whose offsets all point along x.
Flat Flatten(const BvhDocument& standing) {
  Flat flat{standing, std::vector<BvhTrack>(standing.joints.size())};
  // From the new axes of a joint to its old ones.
  std::vector<Quaternion> axes(standing.joints.size());
  for (std::size_t j = 0; j < standing.joints.size(); ++j) {
    const Vec3d offset = standing.joints[j].offset;
    if (standing.joints[j].parent < 0 || Norm(offset) < 1e-6) continue;
    axes[static_cast<std::size_t>(standing.joints[j].parent)] =
        retargeting::ShortestArc({1, 0, 0}, Unit(offset, {}), {0, 1, 0});
    flat.document.joints[j].offset = {Norm(offset), 0, 0};
  }
  for (int frame = 0; frame < standing.frame_count; ++frame) {
    const BvhPose pose = PoseAt(standing, frame);
    for (std::size_t j = 0; j < standing.joints.size(); ++j) {
      const int parent = standing.joints[j].parent;
      const auto p = static_cast<std::size_t>(parent);
      const Quaternion above = parent < 0 ? Quaternion{} : pose.rotations[p] * axes[p];
      flat.tracks[j].turns.push_back(Inverse(above) * pose.rotations[j] * axes[j]);
      flat.tracks[j].places.push_back(parent < 0 ? pose.positions[j]
                                                 : flat.document.joints[j].offset);
    }
  }
  WriteMotion(flat.tracks, 1 / standing.frame_time_s, &flat.document);
  return flat;
}

motion::Clip Read(const BvhDocument& document) {
  const absl::StatusOr<motion::Clip> read = FromBvh(document, "a.bvh");
  EXPECT_THAT(read, IsOk());
  return read.value_or(motion::Clip());
}

motion::Clip Follower() {
  test::PersonOptions options;
  options.yaw = 2;
  options.turn = 3;
  return test::MakePerson(options);
}

class RestPoseTest : public ::testing::Test {
 protected:
  RestPoseTest()
      : standing_(ToBvh(test::MakePerson(), motion::SbuSkeleton(), 0.01)),
        flat_(Flatten(standing_)) {}

  const BvhDocument standing_;
  const Flat flat_;
};

TEST_F(RestPoseTest, TheMotionOfAFlatRigIsRead) {
  EXPECT_LT(test::LargestDistance(Read(flat_.document), Read(standing_)), kOneMillimetre);
}

TEST_F(RestPoseTest, AFollowerOnAFlatRigIsTheOneOnAStandingRig) {
  const absl::StatusOr<BvhDocument> plain = OntoBvhRig(Follower(), standing_, "standing.bvh", {});
  ASSERT_THAT(plain, IsOk());
  retargeting::ReadingReport report;
  BvhImportOptions options;
  options.report = &report;
  const absl::StatusOr<BvhDocument> written =
      OntoBvhRig(Follower(), flat_.document, "flat.bvh", options);
  ASSERT_THAT(written, IsOk());
  EXPECT_THAT(report.Notes(), Contains(HasSubstr("rest pose: that of frame")));
  for (std::size_t j = 0; j < flat_.document.joints.size(); ++j) {
    EXPECT_EQ(written->joints[j].offset.x, flat_.document.joints[j].offset.x);
  }
  EXPECT_LT(test::LargestDistance(Read(*written), Read(*plain)), kThreeCentimetres);
}

TEST_F(RestPoseTest, AFlatRigWithoutAStandingFrameIsRejected) {
  BvhDocument still = flat_.document;
  // Each joint turns by another angle, in all frames.
  const auto channels = static_cast<std::size_t>(still.ChannelCount());
  for (std::size_t i = 0; i < still.values.size(); ++i) {
    still.values[i] = static_cast<float>(i % channels * 37 % 100) - 50;
  }
  EXPECT_THAT(OntoBvhRig(Follower(), still, "flat.bvh", {}).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("flat.bvh: rig: rest pose: expected a standing person")));
}

TEST_F(RestPoseTest, ARestPoseThatStandsIsKept) {
  retargeting::ReadingReport report;
  BvhImportOptions options;
  options.report = &report;
  ASSERT_THAT(OntoBvhRig(Follower(), standing_, "standing.bvh", options), IsOk());
  EXPECT_THAT(report.Notes(), Not(Contains(HasSubstr("rest pose"))));
}

}  // namespace
}  // namespace duet::formats::bvh
