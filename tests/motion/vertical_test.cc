#include "model/motion/vertical.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "model/base/angle.h"
#include "model/motion/levelling.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

constexpr double kRate = 30;
constexpr double kDegree = base::kRadiansPerDegree;

// Neck, hips and feet.
Skeleton Figure() {
  Skeleton skeleton;
  skeleton.joint_names = {"root", "neck", "left_hip", "right_hip", "left_foot", "right_foot"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}, {2, 4}, {3, 5}};
  skeleton.hips = JointPair{2, 3};
  skeleton.feet = JointPair{4, 5};
  return skeleton;
}

// How a person stands.
struct Stance {
  double yaw = 0;         // radians about +y; 0 faces +z
  double forward = 0.03;  // lean as a tangent
  double sideways = 0;    // to the left
  double left_foot_height = 0;
};

// A person at `place`, joints in Figure's order.
std::vector<Vec3> Pose(Vec3 place, const Stance& stance) {
  const auto world = [&](double left, double up, double forward) {
    const Vec3 own = {static_cast<float>(left), static_cast<float>(up),
                      static_cast<float>(forward)};
    return place + RotateY(own, stance.yaw);
  };
  return {world(stance.sideways * 0.9, 0.9, stance.forward * 0.9),
          world(stance.sideways * 1.5, 1.5, stance.forward * 1.5),
          world(0.12, 0.9, 0),
          world(-0.12, 0.9, 0),
          world(0.12, stance.left_foot_height, 0),
          world(-0.12, 0, 0)};
}

Clip Standing(double seconds, Vec3 place, const Stance& stance) {
  Clip clip{Figure().joint_names, kRate, {}};
  const std::vector<Vec3> pose = Pose(place, stance);
  for (int t = 0; t < seconds * kRate; ++t) clip.Append(pose);
  return clip;
}

// Stands for a second at each of 9 places that are 1 m apart, facing `yaw(place)`.
template <typename Yaw>
Clip Walking(Stance stance, const Yaw& yaw, double floor_slope = 0) {
  Clip clip{Figure().joint_names, kRate, {}};
  for (int i = 0; i < 9; ++i) {
    stance.yaw = yaw(i);
    const auto x = static_cast<float>(i % 3), z = static_cast<float>(i / 3);
    const Clip still = Standing(1, {x, static_cast<float>(floor_slope) * x, z}, stance);
    clip.Append(still.poses.all());
  }
  return clip;
}

double OneWay(int) { return 0; }
double EveryWay(int place) { return 2 * base::kPi * place / 9; }

Vec3 UpAt(double degrees, double azimuth) {
  const double tilt = degrees * kDegree;
  return {static_cast<float>(std::sin(tilt) * std::cos(azimuth)),
          static_cast<float>(std::cos(tilt)),
          static_cast<float>(std::sin(tilt) * std::sin(azimuth))};
}

// The clip as a camera whose vertical is `up` captures it.
Clip Captured(Clip clip, Vec3 up) {
  clip.poses = Levelling(up, 0).Invert(std::move(clip.poses));
  return clip;
}

VerticalEstimate EstimateFrom(const std::vector<Clip>& people) {
  VerticalEvidence evidence(Figure());
  for (const Clip& person : people) evidence.Add(person);
  return evidence.Estimate();
}

double DegreesBetween(Vec3 a, Vec3 b) {
  return std::acos(std::min(1.0, static_cast<double>(Dot(a, b)))) / kDegree;
}

TEST(VerticalTest, WhoWalksAboutOnALevelFloorIsLevel) {
  const VerticalEstimate estimate = EstimateFrom({Walking({}, EveryWay)});
  EXPECT_EQ(estimate.verdict, TiltVerdict::kLevel);
  EXPECT_LT(estimate.tilt_degrees, 0.5);
  EXPECT_LT(estimate.error_degrees, 3);
  EXPECT_EQ(estimate.places, 18) << "nine for each foot";
  EXPECT_THAT(Describe(estimate), StartsWith("level within 5 degrees (0."));
}

TEST(VerticalTest, ATiltIsFoundInEveryDirection) {
  for (const double degrees : {7, 10, 15}) {
    for (int eighth = 0; eighth < 8; ++eighth) {
      const Vec3 up = UpAt(degrees, eighth * base::kPi / 4);
      const VerticalEstimate estimate = EstimateFrom({Captured(Walking({}, EveryWay), up)});
      EXPECT_EQ(estimate.verdict, TiltVerdict::kTilted) << degrees << " " << eighth;
      EXPECT_LT(DegreesBetween(estimate.up, up), 1) << degrees << " " << eighth;
    }
  }
}

TEST(VerticalTest, WhoLeansInOnePlaceMayBeATiltedCamera) {
  // The same picture: a person who leans forwards, and a tilted camera.
  const Clip leans = Standing(20, {}, {0, std::tan(12 * kDegree), 0, 0});
  const Clip tilted = Captured(Standing(20, {}, {0, 0, 0, 0}), UpAt(12, base::kPi / 2));
  for (const Clip& clip : {leans, tilted}) {
    const VerticalEstimate estimate = EstimateFrom({clip});
    EXPECT_EQ(estimate.verdict, TiltVerdict::kUnknown);
    EXPECT_EQ(estimate.places, 0) << "one place is none";
    EXPECT_THAT(Describe(estimate), HasSubstr("cannot tell a tilted camera from people who lean"));
  }
}

TEST(VerticalTest, TheFloorShowsThatALeaningWalkerLeans) {
  const Clip leans = Walking({0, std::tan(10 * kDegree), 0, 0}, OneWay);
  const VerticalEstimate estimate = EstimateFrom({leans});
  EXPECT_NE(estimate.verdict, TiltVerdict::kTilted);
  EXPECT_LT(estimate.tilt_degrees, 5);
}

TEST(VerticalTest, PeopleWhoLeanToEachOtherAreLevel) {
  // Hugs by several pairs, along x.
  std::vector<Clip> people;
  for (int i = 0; i < 8; ++i) {
    const auto z = static_cast<float>(i);
    const double lean = std::tan(15 * kDegree);
    people.push_back(Standing(6, {0, 0, z}, {base::kPi / 2, lean, 0, 0}));
    people.push_back(Standing(6, {1, 0, z}, {-base::kPi / 2, lean, 0, 0}));
  }
  const VerticalEstimate estimate = EstimateFrom(people);
  EXPECT_EQ(estimate.verdict, TiltVerdict::kLevel);
  EXPECT_LT(estimate.tilt_degrees, 1);
  for (Clip& person : people) person = Captured(person, UpAt(10, base::kPi / 2));
  const VerticalEstimate tilted = EstimateFrom(people);
  EXPECT_EQ(tilted.verdict, TiltVerdict::kTilted);
  EXPECT_LT(DegreesBetween(tilted.up, UpAt(10, base::kPi / 2)), 2);
}

TEST(VerticalTest, ARampContradictsUprightPeople) {
  const Clip climbs = Walking({}, EveryWay, std::tan(25 * kDegree));
  const VerticalEstimate estimate = EstimateFrom({climbs});
  EXPECT_EQ(estimate.verdict, TiltVerdict::kUnknown);
  EXPECT_GT(estimate.disagreement, 3);
  EXPECT_THAT(Describe(estimate), HasSubstr("as on a slope or stairs"));
}

TEST(VerticalTest, NobodyAndWhoHasNoFeetAreNoEvidence) {
  EXPECT_EQ(EstimateFrom({}).verdict, TiltVerdict::kUnknown);
  Skeleton footless = Figure();
  footless.feet.reset();
  VerticalEvidence evidence(footless);
  evidence.Add(Walking({}, EveryWay));
  EXPECT_EQ(evidence.Estimate().verdict, TiltVerdict::kUnknown);
}

TEST(VerticalTest, PositionsThatAreNotFiniteAreNoEvidence) {
  Clip clip = Walking({}, EveryWay);
  for (Vec3& joint : clip.poses.all()) joint.x = std::nanf("");
  EXPECT_EQ(EstimateFrom({clip}).verdict, TiltVerdict::kUnknown);
  EXPECT_EQ(EstimateFrom({clip}).places, 0);
}

TEST(VerticalTest, WhoSitsIsNoEvidence) {
  Skeleton skeleton;
  skeleton.joint_names = {"root",      "neck",       "left_hip",  "right_hip",
                          "left_knee", "right_knee", "left_foot", "right_foot"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}, {2, 4}, {3, 5}, {4, 6}, {5, 7}};
  skeleton.hips = JointPair{2, 3};
  skeleton.feet = JointPair{6, 7};
  // On a chair: the neck is half a metre behind the feet.
  const std::vector<Vec3> sits = {{0, 0.5F, 0},      {0, 1.1F, 0},         {0.1F, 0.45F, 0},
                                  {-0.1F, 0.45F, 0}, {0.1F, 0.45F, 0.45F}, {-0.1F, 0.45F, 0.45F},
                                  {0.1F, 0, 0.45F},  {-0.1F, 0, 0.45F}};
  std::vector<Vec3> stands = sits;
  stands[4] = {0.1F, 0.2F, 0.2F}, stands[5] = {-0.1F, 0.2F, 0.2F};
  const auto estimate = [&](const std::vector<Vec3>& pose) {
    Clip clip{skeleton.joint_names, kRate, {}};
    for (int t = 0; t < 20 * kRate; ++t) clip.Append(pose);
    VerticalEvidence evidence(skeleton);
    evidence.Add(clip);
    return evidence.Estimate();
  };
  EXPECT_EQ(estimate(sits).verdict, TiltVerdict::kUnknown);
  EXPECT_LT(estimate(sits).tilt_degrees, 0.01);
  EXPECT_THAT(Describe(estimate(sits)), HasSubstr("nobody stands on both feet"));
  EXPECT_GT(estimate(stands).tilt_degrees, 10) << "the same directions, with straighter legs";
}

}  // namespace
}  // namespace duet::motion
