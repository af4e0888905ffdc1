#include "model/cleanup/footsteps.h"

#include "model/authoring/puppet.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kFloor = static_cast<float>(kAnkle);

motion::Poses Walked(motion::Poses poses, int settled = 0,
                     const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  WalkInSteps(skeleton, body::FindBody(skeleton), kFloor, {}, {kRate, settled}, &poses);
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

TEST(WalkInSteps, FixesASlidingFoot) {
  const motion::Poses sliding = Sliding(), held = Walked(sliding);
  for (const int foot : {11, 14}) {
    EXPECT_GT(Slide(sliding, foot, 0, kFrames - 1), 0.002);
    EXPECT_LT(Slide(held, foot, 0, kFrames - 1), 0.0002);
  }
  EXPECT_LT(LargestLengthChange(held, sliding), 1e-5f);
  // The body goes along with both feet, no farther than they do.
  EXPECT_LT(LargestDistance(held, sliding), 0.06f);
}

TEST(WalkInSteps, StepsStaySteps) {
  const motion::Poses walking = Walking(), held = Walked(walking);
  EXPECT_LT(LargestDistance(walking, held), 0.07f);
  EXPECT_NEAR(held.at(kFrames - 1, 11).z - held.at(0, 11).z, 0.3f, 0.02f);
  EXPECT_LT(LargestStep(held), 1.5f * LargestStep(walking));
}

TEST(WalkInSteps, FeetThatStandStay) {
  EXPECT_LT(LargestDistance(Walked(Puppet()), Puppet()), 1e-4f);
}

// The speed of a foot that arrives at a frame, m/s.
double Speed(const motion::Poses& poses, int foot, int frame) {
  return kRate * double{Distance(poses.at(frame, foot), poses.at(frame - 1, foot))};
}

TEST(WalkInSteps, ABodyThatSlidesSteps) {
  const motion::Poses sliding = Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0.3f * static_cast<float>(t / kRate), 0, 0};
  });
  const motion::Poses walked = Walked(sliding);
  int steps = 0;
  for (int t = 1; t < kFrames; ++t) {
    EXPECT_LT(std::min(Speed(walked, 11, t), Speed(walked, 14, t)), 0.05) << "frame " << t;
    steps += std::max(Speed(walked, 11, t), Speed(walked, 14, t)) > 0.2;
  }
  EXPECT_GT(steps, 10);
  EXPECT_LT(LargestDistance(walked, sliding), 0.25f);
  EXPECT_LT(LargestLengthChange(walked, sliding), 1e-5f);
}

// A foot that hovers takes a step of its own, has landed for a moment, and is raised.
TEST(PlanFootsteps, AFootThatStandsForAMomentDoesNotDrop) {
  constexpr float kHovers = 0.115f;
  for (int raised = 14; raised < 20; ++raised) {
    std::vector<Vec3> still(kFrames, Vec3{0.3f, kFloor, 0}), hovering;
    for (int t = 0; t < kFrames; ++t) {
      const float x = 0.3f * static_cast<float>(std::max(0, t - 8) / kRate);
      hovering.push_back({x, kFloor + kHovers + (t >= raised ? 0.08f : 0), 0});
    }
    const FootPath path = PlanFootsteps({hovering, still}, kFloor, {}, {kRate, 0}).front();
    for (int t = 11; t + 1 < kFrames; ++t) {
      const auto height = [&](int frame) { return path.places[static_cast<std::size_t>(frame)].y; };
      EXPECT_GT(height(t), std::min(height(t - 1), height(t + 1)) - 0.05f) << raised << ", " << t;
    }
  }
}

TEST(WalkInSteps, AStepIsLifted) {
  const motion::Poses walked = Walked(Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0.3f * static_cast<float>(t / kRate), 0, 0};
  }));
  float highest = 0;
  for (int t = 0; t < kFrames; ++t) {
    highest = std::max(highest, std::max(walked.at(t, 11).y, walked.at(t, 14).y) - kFloor);
  }
  EXPECT_GT(highest, 0.02f);
  EXPECT_LT(highest, 0.09f);
}

// Its legs would not reach the places where it stands.
TEST(WalkInSteps, ABodyThatStridesSinks) {
  const motion::Poses walked = Walked(Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0.9f * static_cast<float>(t / kRate), 0, 0};
  }));
  float lowest = 2;
  for (int t = 0; t < kFrames; ++t) lowest = std::min(lowest, walked.at(t, 2).y);
  EXPECT_LT(lowest, Puppet().at(0, 2).y - 0.005f);
}

TEST(WalkInSteps, AFootInTheAirIsFree) {
  const motion::Poses kicking = Puppet([](double t, authoring::PuppetPose* pose) {
    pose->left_foot.target = {0.12, 0.4, 0.1 + 0.02 * std::sin(3 * t)};
  });
  const motion::Poses held = Walked(kicking);
  for (int t = 0; t < kFrames; ++t) EXPECT_LT(Distance(held.at(t, 11), kicking.at(t, 11)), 1e-4f);
}

TEST(WalkInSteps, ContinuesTheContactsOfSettledFrames) {
  const motion::Poses sliding = Sliding();
  const motion::Poses held = Walked(sliding, 15);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(held[t], sliding[t]);
  EXPECT_LT(Distance(held.at(16, 11), sliding.at(14, 11)), 0.002f);
  EXPECT_LT(LargestStep(held), 1.2f * LargestStep(sliding));
}

// The paths of two feet that are planned again in every frame, as in a live session: what follows
// the frames that were sent glides on from them.
motion::Poses PlannedInEveryFrame(double metres_per_second) {
  const float way = static_cast<float>(metres_per_second / kRate);
  motion::Poses sent(2, {{0.12f, kFloor, 0}, {-0.12f, kFloor, 0}});
  while (sent.frame_count() < kFrames) {
    Timing timing{kRate, sent.frame_count()};
    timing.ease_seconds = 0;
    timing.anticipation_seconds = 0.2;
    timing.continues_steps = true;
    std::vector<std::vector<Vec3>> tracks(2);
    for (int t = 0; t < timing.settled + 8; ++t) {
      for (int foot = 0; foot < 2; ++foot) {
        const int known = std::min(t, timing.settled - 1);
        Vec3 at = sent.at(known, foot);
        at.z += way * static_cast<float>(t - known);
        at.y = kFloor + (at.y - kFloor) * std::pow(0.6f, static_cast<float>(t - known));
        tracks[static_cast<std::size_t>(foot)].push_back(at);
      }
    }
    const std::vector<FootPath> paths = PlanFootsteps(tracks, kFloor, {}, timing);
    const std::size_t next = static_cast<std::size_t>(timing.settled);
    sent.Append(std::vector<Vec3>{paths[0].places[next], paths[1].places[next]});
  }
  return sent;
}

TEST(PlanFootsteps, AStepThatIsPlannedAgainEnds) {
  const motion::Poses sent = PlannedInEveryFrame(/*metres_per_second=*/0.6);
  for (int foot = 0; foot < 2; ++foot) {
    int moved = 0, longest = 0, stands = 0;
    for (int t = 1; t < sent.frame_count(); ++t) {
      moved = Speed(sent, foot, t) > 0.3 ? moved + 1 : 0;
      longest = std::max(longest, moved);
      stands += moved == 0;
    }
    EXPECT_GE(longest, 3) << foot;
    EXPECT_LE(longest, 6) << foot;
    EXPECT_GT(stands, kFrames / 4) << foot;
  }
}

TEST(WalkInSteps, NeedsLegsOfTwoBones) {
  EXPECT_EQ(Walked(Sliding(), 0, WithoutFeet()), Sliding());
}

}  // namespace
}  // namespace duet::cleanup
