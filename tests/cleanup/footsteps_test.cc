#include "model/cleanup/contacts.h"

#include "model/authoring/puppet.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kFloor = static_cast<float>(kAnkle);

motion::Poses Held(motion::Poses poses, int settled = 0,
                   const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  HoldContacts(skeleton, FindBody(skeleton), kFloor, {}, {kRate, settled}, &poses);
  return poses;
}

// The mean way of a foot along the floor from frame to frame, metres.
double Slide(const motion::Poses& poses, int foot, int first, int last) {
  double sum = 0;
  for (int t = first + 1; t <= last; ++t) {
    const Vec3 step = poses.at(t, foot) - poses.at(t - 1, foot);
    sum += std::hypot(step.x, step.z);
  }
  return sum / (last - first);
}

// Both feet wander by a few centimetres, as a network's do, below a body that sways.
motion::Poses Sliding() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    pose->torso.y = 1.05;
    pose->torso.x = 0.03 * std::sin(2 * t);
    pose->left_foot.target.x += 0.03 * std::sin(3 * t);
    pose->right_foot.target.z += 0.03 * std::cos(2.5 * t);
  });
}

// Steps forwards: each foot stands for a second, then moves 30 cm within 0.4 seconds.
motion::Poses Walking() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    const auto step = [](double at, authoring::PuppetPose::Limb* foot) {
      const double s = std::min(1.0, std::max(0.0, (at - 1) / 0.4));
      foot->target.z += 0.3 * s * s * (3 - 2 * s);
      foot->target.y += 0.15 * std::sin(3.14159265 * s);
    };
    pose->torso.y = 1.03;
    pose->torso.z = 0.1 * t;
    step(t, &pose->left_foot);
    step(t - 0.6, &pose->right_foot);
  });
}

TEST(HoldContacts, FixesASlidingFoot) {
  const motion::Poses sliding = Sliding(), held = Held(sliding);
  for (const int foot : {11, 14}) {
    EXPECT_GT(Slide(sliding, foot, 0, kFrames - 1), 0.002);
    EXPECT_LT(Slide(held, foot, 0, kFrames - 1), 0.0002);
  }
  EXPECT_LT(LargestLengthChange(held, sliding), 1e-5f);
  // The body goes along with both feet, no farther than they do.
  EXPECT_LT(LargestDistance(held, sliding), 0.06f);
}

TEST(HoldContacts, StepsStaySteps) {
  const motion::Poses walking = Walking(), held = Held(walking);
  EXPECT_LT(LargestDistance(walking, held), 0.07f);
  EXPECT_NEAR(held.at(kFrames - 1, 11).z - held.at(0, 11).z, 0.3f, 0.02f);
  EXPECT_LT(LargestStep(held), 1.5f * LargestStep(walking));
}

TEST(HoldContacts, FeetThatStandStay) {
  EXPECT_LT(LargestDistance(Held(Puppet()), Puppet()), 1e-4f);
}

TEST(HoldContacts, AFootThatDriftsIsNotLeftBehind) {
  const motion::Poses drifting = Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0.15f * static_cast<float>(t / kRate), 0, 0};
  });
  const motion::Poses held = Held(drifting);
  EXPECT_LT(LargestDistance(held, drifting), 0.1f);
  EXPECT_LT(LargestStep(held), 0.06f);
}

TEST(HoldContacts, AFootInTheAirIsFree) {
  const motion::Poses kicking = Puppet([](double t, authoring::PuppetPose* pose) {
    pose->left_foot.target = {0.12, 0.4, 0.1 + 0.02 * std::sin(3 * t)};
  });
  const motion::Poses held = Held(kicking);
  for (int t = 0; t < kFrames; ++t) EXPECT_LT(Distance(held.at(t, 11), kicking.at(t, 11)), 1e-4f);
}

TEST(HoldContacts, ContinuesTheContactsOfSettledFrames) {
  const motion::Poses sliding = Sliding();
  const motion::Poses held = Held(sliding, 15);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(held[t], sliding[t]);
  EXPECT_LT(Distance(held.at(16, 11), sliding.at(14, 11)), 0.002f);
  EXPECT_LT(LargestStep(held), 1.2f * LargestStep(sliding));
}

TEST(HoldContacts, NeedsLegsOfTwoBones) { EXPECT_EQ(Held(Sliding(), 0, WithoutFeet()), Sliding()); }

}  // namespace
}  // namespace duet::cleanup
