
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "server/service/reply_mapping.h"
#include "tests/support/sample_motion.h"

namespace duet::server::service {
namespace {

using motion::Coordinates;
using motion::LengthUnit;
using motion::UpAxis;
using retargeting::Quaternion;
using retargeting::Vec3d;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();
constexpr double kRate = 15;

// The header and the chunk of a reply with rotations. Its joints are the model's in reverse order.
struct Reply {
  v1::SynthesisHeader header;
  v1::MotionChunk chunk;
};

Reply Answer(const Coordinates& coordinates, motion::Poses follower,
             const std::optional<motion::Levelling>& levelling = {}) {
  ReplyMapping mapping;
  mapping.coordinates = coordinates;
  mapping.levelling = levelling;
  for (int joint = kSkeleton.joint_count() - 1; joint >= 0; --joint) {
    mapping.joints.push_back(joint);
  }
  mapping.rig = MakeRigSource(kSkeleton, test::SwayingMotion(40, kRate), kRate);
  ReplyRig rig(mapping, follower);
  Reply reply;
  rig.FillHeader(reply.header);
  rig.AddRotations(&follower, reply.chunk);
  reply.chunk.set_frame_count(static_cast<uint32_t>(follower.frame_count()));
  AppendPositions(mapping, follower, reply.chunk.mutable_positions());
  return reply;
}

Vec3d Position(const Reply& reply, int frame, int joint) {
  const float* xyz = reply.chunk.positions().data() + 3 * (frame * kSkeleton.joint_count() + joint);
  return {xyz[0], xyz[1], xyz[2]};
}

// What docs/rotations.md tells a caller to do. [rig joints]
std::vector<Vec3d> Forward(const Reply& reply, int frame) {
  std::vector<Vec3d> at;
  std::vector<Quaternion> world;
  const float* value = reply.chunk.rotations().data() + 4 * frame * reply.header.rig_size();
  for (const v1::RigJoint& joint : reply.header.rig()) {
    const Quaternion local{value[3], value[0], value[1], value[2]};
    value += 4;
    if (joint.parent() < 0) {
      at.push_back(Position(reply, frame, static_cast<int>(joint.joint())));
      world.push_back(local);
      continue;
    }
    const auto parent = static_cast<std::size_t>(joint.parent());
    const Vec3d offset{joint.offset().x(), joint.offset().y(), joint.offset().z()};
    at.push_back(at[parent] + Rotate(world[parent], offset));
    world.push_back(world[parent] * local);
  }
  return at;
}

double WorstDistance(const Reply& reply) {
  double worst = 0;
  for (int frame = 0; frame < static_cast<int>(reply.chunk.frame_count()); ++frame) {
    const std::vector<Vec3d> at = Forward(reply, frame);
    for (int j = 0; j < reply.header.rig_size(); ++j) {
      const int joint = static_cast<int>(reply.header.rig(j).joint());
      worst =
          std::max(worst, Norm(at[static_cast<std::size_t>(j)] - Position(reply, frame, joint)));
    }
  }
  return worst;
}

class ReplyRigTest : public ::testing::TestWithParam<Coordinates> {
 protected:
  // Of a metre.
  double Scale() const { return GetParam().unit == LengthUnit::kMillimetres ? 1000 : 1; }
  Vec3d InCallersAxes(motion::Vec3 world) const {
    return retargeting::ToDouble(FromWorld({LengthUnit::kMetres, GetParam().up_axis}, world));
  }
};

TEST_P(ReplyRigTest, ForwardKinematicsGivesThePositionsOfLevelAndTiltedWorlds) {
  const Reply level = Answer(GetParam(), test::SwayingMotion(40, kRate));
  ASSERT_EQ(level.chunk.rotations_size(), 40 * level.header.rig_size() * 4);
  EXPECT_LT(WorstDistance(level), 1e-5 * Scale());
  const Reply tilted =
      Answer(GetParam(), test::SwayingMotion(40, kRate), motion::Levelling({0.2f, 1, -0.1f}, 0));
  EXPECT_LT(WorstDistance(tilted), 1e-5 * Scale());
  EXPECT_GT(Norm(Position(tilted, 5, 0) - Position(level, 5, 0)), 0.03 * Scale());
}

TEST_P(ReplyRigTest, QuaternionsHaveLengthOneAndKeepTheirSigns) {
  const Reply reply = Answer(GetParam(), test::SwayingMotion(40, kRate));
  const auto& values = reply.chunk.rotations();
  const int width = 4 * reply.header.rig_size();
  for (int i = 0; i < values.size(); i += 4) {
    const auto* q = values.data() + i;
    EXPECT_NEAR(std::inner_product(q, q + 4, q, 0.0), 1, 1e-5);
    if (i < width) continue;
    EXPECT_GT(std::inner_product(q, q + 4, q - width, 0.0), 0);
  }
}

TEST_P(ReplyRigTest, TheRestPoseStandsUprightInTheCallersAxes) {
  const Reply reply = Answer(GetParam(), test::SwayingMotion(40, kRate));
  std::vector<Vec3d> at;
  for (const v1::RigJoint& joint : reply.header.rig()) {
    const Vec3d offset{joint.offset().x(), joint.offset().y(), joint.offset().z()};
    at.push_back(joint.parent() < 0 ? offset
                                    : at[static_cast<std::size_t>(joint.parent())] + offset);
  }
  const auto place = [&](const std::string& name) {
    for (int j = 0; j < reply.header.rig_size(); ++j) {
      if (reply.header.rig(j).name() == name) return at[static_cast<std::size_t>(j)];
    }
    ADD_FAILURE() << name;
    return Vec3d{};
  };
  const Vec3d up = InCallersAxes({0, 1, 0}), left = InCallersAxes({1, 0, 0});
  EXPECT_GT(Dot(place("head") - place("left_foot"), up), 1.2 * Scale());
  EXPECT_GT(Dot(place("left_hand") - place("right_hand"), left), 1.0 * Scale());
  EXPECT_NEAR(Dot(place("left_hand") - place("left_shoulder"), up), 0, 1e-5 * Scale());
  // Left and up as stated, the person faces left x up: +z, -y for z up, -z for y down.
  const Vec3d ahead = Cross(left, up);
  const Vec3d expected = GetParam().up_axis == UpAxis::kYUp   ? Vec3d{0, 0, 1}
                         : GetParam().up_axis == UpAxis::kZUp ? Vec3d{0, -1, 0}
                                                              : Vec3d{0, 0, -1};
  EXPECT_NEAR(Norm(ahead - expected), 0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Callers, ReplyRigTest,
                         ::testing::Values(Coordinates{LengthUnit::kMetres, UpAxis::kYUp},
                                           Coordinates{LengthUnit::kMetres, UpAxis::kZUp},
                                           Coordinates{LengthUnit::kMetres, UpAxis::kYDown},
                                           Coordinates{LengthUnit::kMillimetres, UpAxis::kYUp},
                                           Coordinates{LengthUnit::kMillimetres, UpAxis::kZUp}));

TEST(ReplyRig, EveryJointHasItsNameAndFollowsItsParent) {
  const Reply reply = Answer({}, test::SwayingMotion(2, kRate));
  ASSERT_GT(reply.header.rig_size(), kSkeleton.joint_count());
  EXPECT_EQ(reply.header.rig(0).parent(), -1);
  EXPECT_EQ(reply.header.rig(0).name(), "torso");
  std::vector<bool> named(kSkeleton.joint_names.size());
  for (int j = 0; j < reply.header.rig_size(); ++j) {
    const v1::RigJoint& joint = reply.header.rig(j);
    EXPECT_LT(joint.parent(), j);
    const auto model = static_cast<std::size_t>(kSkeleton.joint_count() - 1) - joint.joint();
    if (joint.name() == kSkeleton.joint_names[model]) named[model] = true;
  }
  EXPECT_EQ(std::count(named.begin(), named.end(), true), kSkeleton.joint_count());
}

// Positions of bones that changed their lengths move to the rig; the root stays.
TEST(ReplyRig, PositionsAreThoseOfTheRig) {
  motion::Poses follower = test::SwayingMotion(10, kRate);
  const int hand = kSkeleton.Find("left_hand"), elbow = kSkeleton.Find("left_elbow");
  motion::Vec3& at = follower.at(5, hand);
  at = follower.at(5, elbow) + (at - follower.at(5, elbow)) * 0.8F;
  const Reply reply = Answer({}, follower);
  EXPECT_LT(WorstDistance(reply), 1e-5);
  const int in_reply = kSkeleton.joint_count() - 1 - hand;
  const double moved =
      Norm(Position(reply, 5, in_reply) - retargeting::ToDouble(follower.at(5, hand)));
  EXPECT_GT(moved, 0.02);
  EXPECT_LT(moved, 0.1);
}

}  // namespace
}  // namespace duet::server::service
