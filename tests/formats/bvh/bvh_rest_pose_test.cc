// Rigs whose offsets make no standing person, as those of LAFAN1 and Kimodo: each bone points along
// the x axis of its joint at rest, and only the motion makes a person.
#include <cstddef>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/formats/gltf/gltf_rig.h"
#include "tests/formats/gltf/gltf_fixture.h"
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
  const BvhKinematics kinematics(standing);
  for (int frame = 0; frame < standing.frame_count; ++frame) {
    const BvhKinematics::Pose pose = kinematics.PoseAt(frame);
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
      : standing_(ToBvh(test::MakePerson(), motion::SbuSkeleton(), 0.01).value()),
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
  std::vector<std::string> notes;
  BvhImportOptions options;
  options.notes = &notes;
  const absl::StatusOr<BvhDocument> written =
      OntoBvhRig(Follower(), flat_.document, "flat.bvh", options);
  ASSERT_THAT(written, IsOk());
  EXPECT_THAT(notes, Contains(HasSubstr("rest pose: that of frame")));
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
  std::vector<std::string> notes;
  BvhImportOptions options;
  options.notes = &notes;
  ASSERT_THAT(OntoBvhRig(Follower(), standing_, "standing.bvh", options), IsOk());
  EXPECT_THAT(notes, Not(Contains(HasSubstr("rest pose"))));
}

// The same rig and motion as glTF, in metres.
std::string FlatGltf(const Flat& flat) {
  test::GltfBuilder builder;
  std::vector<float> times;
  for (int frame = 0; frame < flat.document.frame_count; ++frame) {
    times.push_back(static_cast<float>(frame * flat.document.frame_time_s));
  }
  const int input = builder.AddAccessor(times, "SCALAR");
  nlohmann::json animation = {{"name", "walk"}};
  for (std::size_t j = 0; j < flat.document.joints.size(); ++j) {
    const BvhJoint& joint = flat.document.joints[j];
    const Vec3d offset = joint.offset * 0.01;
    const int node =
        builder.AddNode({{"name", joint.name}, {"translation", {offset.x, offset.y, offset.z}}});
    if (joint.parent >= 0) {
      builder.json()["nodes"][static_cast<std::size_t>(joint.parent)]["children"].push_back(node);
    }
    std::vector<float> turns, places;
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
      const Quaternion turn = flat.tracks[j].turns[frame];
      const Vec3d place = flat.tracks[j].places[frame] * 0.01;
      for (double v : {turn.x, turn.y, turn.z, turn.w}) turns.push_back(static_cast<float>(v));
      for (double v : {place.x, place.y, place.z}) places.push_back(static_cast<float>(v));
    }
    const auto add = [&](const char* path, int output) {
      animation["samplers"].push_back({{"input", input}, {"output", output}});
      animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                       {"target", {{"node", node}, {"path", path}}}});
    };
    if (!joint.end_site) add("rotation", builder.AddAccessor(turns, "VEC4"));
    if (joint.parent < 0) add("translation", builder.AddAccessor(places, "VEC3"));
  }
  builder.json()["animations"].push_back(animation);
  return builder.Binary();
}

absl::StatusOr<std::string> NoFiles(const std::string& name) { return absl::NotFoundError(name); }

TEST_F(RestPoseTest, AFollowerOnAFlatGltfRigIsTheOneOnAStandingRig) {
  const absl::StatusOr<BvhDocument> plain = OntoBvhRig(Follower(), standing_, "standing.bvh", {});
  ASSERT_THAT(plain, IsOk());
  const absl::StatusOr<std::string> written = gltf::OntoGltfRig(
      Follower(), FlatGltf(flat_), "flat.glb", NoFiles, {}, gltf::GltfContainer::kBinary);
  ASSERT_THAT(written, IsOk());
  const absl::StatusOr<gltf::GltfDocument> document = gltf::ParseGltf(*written, "out.glb");
  ASSERT_THAT(document, IsOk());
  const absl::StatusOr<motion::Clip> read = gltf::FromGltf(*document, "out.glb", NoFiles, {});
  ASSERT_THAT(read, IsOk());
  EXPECT_LT(test::LargestDistance(*read, Read(*plain)), kThreeCentimetres);
}

}  // namespace
}  // namespace duet::formats::bvh
