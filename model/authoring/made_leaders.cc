#include "model/authoring/made_leaders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::authoring {
namespace {

using motion::Poses;
using motion::Vec3;

// How an arm hangs from its shoulder, radians: forwards, sideways, and the elbow's bend.
struct MadeArm {
  double swing = 0, spread = 0.12, elbow = 0.25;
};

// The parameters of a body.
struct MadeBody {
  Vec3 hips;        // the middle of both
  double yaw = 0;   // about +y; at 0 it faces -z
  double bend = 0;  // of the trunk, forwards, radians
  Vec3 left_foot, right_foot;
  MadeArm left_arm, right_arm;
};

// Height of the middle of the hips with slightly bent knees, metres.
constexpr float kStandingHips = 0.80f;
// Distance of each foot from the middle.
constexpr float kHalfStance = 0.10f;

// Lengths of a person of 1.7 m.
constexpr float kHalfHips = 0.09f, kThigh = 0.42f, kShin = 0.41f;
constexpr float kTorso = 0.22f, kNeck = 0.46f, kHead = 0.64f;  // above the hips, along the trunk
constexpr float kShoulderHeight = 0.42f, kHalfShoulders = 0.17f;
constexpr float kUpperArm = 0.28f, kForearm = 0.25f;

// Turns forwards about the axis from left to right: up goes to -z.
Vec3 Bend(Vec3 p, double radians) {
  const auto c = static_cast<float>(std::cos(radians)), s = static_cast<float>(std::sin(radians));
  return {p.x, c * p.y + s * p.z, c * p.z - s * p.y};
}

// The middle joint of a limb of two bones whose end is as near to `*end` as they reach; it lies
// towards `forwards`.
Vec3 MiddleJoint(Vec3 start, Vec3 forwards, Vec3* end) {
  const Vec3 line = *end - start;
  const float length =
      std::clamp(Norm(line), std::abs(kThigh - kShin) + 1e-3f, kThigh + kShin - 1e-3f);
  const Vec3 along = line / Norm(line);
  *end = start + along * length;
  const float part = (kThigh * kThigh - kShin * kShin + length * length) / (2 * length);
  const float off = std::sqrt(std::max(0.0f, kThigh * kThigh - part * part));
  const Vec3 side = forwards - along * Dot(forwards, along);
  return start + along * part + side / Norm(side) * off;
}

// Shoulder, elbow, hand in the trunk's coordinates; `side` is -1 on the left.
struct ArmJoints {
  Vec3 shoulder, elbow, hand;
};
ArmJoints PoseArm(const MadeArm& arm, float side) {
  const auto direction = [&](double swing) {
    const auto out = static_cast<float>(std::sin(arm.spread)) * side;
    const double down = std::cos(arm.spread);
    return Vec3{out, static_cast<float>(-down * std::cos(swing)),
                static_cast<float>(-down * std::sin(swing))};
  };
  ArmJoints joints;
  joints.shoulder = {side * kHalfShoulders, kShoulderHeight, 0};
  joints.elbow = joints.shoulder + direction(arm.swing) * kUpperArm;
  joints.hand = joints.elbow + direction(arm.swing + arm.elbow) * kForearm;
  return joints;
}

// The joints of SbuSkeleton. Limbs have constant lengths; a leg points towards a foot position out
// of reach.
std::vector<Vec3> PoseOf(const MadeBody& body) {
  const auto trunk = [&](Vec3 p) { return body.hips + RotateY(Bend(p, body.bend), body.yaw); };
  const Vec3 forwards = RotateY(Vec3{0, 0, -1}, body.yaw);
  const Vec3 left_hip = body.hips + RotateY(Vec3{-kHalfHips, 0, 0}, body.yaw);
  const Vec3 right_hip = body.hips + RotateY(Vec3{kHalfHips, 0, 0}, body.yaw);
  Vec3 left_foot = body.left_foot, right_foot = body.right_foot;
  const Vec3 left_knee = MiddleJoint(left_hip, forwards, &left_foot);
  const Vec3 right_knee = MiddleJoint(right_hip, forwards, &right_foot);
  const ArmJoints left = PoseArm(body.left_arm, -1), right = PoseArm(body.right_arm, 1);
  return {trunk({0, kHead, 0}),
          trunk({0, kNeck, 0}),
          trunk({0, kTorso, 0}),
          trunk(left.shoulder),
          trunk(left.elbow),
          trunk(left.hand),
          trunk(right.shoulder),
          trunk(right.elbow),
          trunk(right.hand),
          left_hip,
          left_knee,
          left_foot,
          right_hip,
          right_knee,
          right_foot};
}

float Wave(double amplitude, double seconds, double period) {
  return static_cast<float>(amplitude * std::sin(2 * M_PI * seconds / period));
}

// The place and direction of a body.
struct Place {
  Vec3 at;
  double yaw = 0;
};
using PlaceAt = Place (*)(double seconds);

// Steps that keep the feet under a moving body: a foot stands for three fifths of a cycle where the
// body passes over it in the middle of that time, and swings to its next stand for the rest.
struct Gait {
  double cycle_seconds;
  double lift_metres;
};
constexpr double kStance = 0.6;

Vec3 Stand(const Place& place, float side) {
  return place.at + RotateY(Vec3{side * kHalfStance, 0, 0}, place.yaw);
}

Vec3 FootAt(const Gait& gait, PlaceAt place, double seconds, float side) {
  const double offset = side < 0 ? 0 : 0.5;
  const double cycle = seconds / gait.cycle_seconds + offset;
  const double first = std::floor(cycle), phase = cycle - first;
  const auto stand = [&](double number) {
    return Stand(place((number + kStance / 2 - offset) * gait.cycle_seconds), side);
  };
  if (phase < kStance) return stand(first);
  const double way = (phase - kStance) / (1 - kStance);
  const double smooth = way * way * (3 - 2 * way);
  Vec3 foot = Lerp(stand(first), stand(first + 1), static_cast<float>(smooth));
  foot.y = static_cast<float>(gait.lift_metres * std::sin(M_PI * way));
  return foot;
}

MadeBody Standing() {
  MadeBody body;
  body.hips = {0, kStandingHips, 0};
  body.left_foot = Stand({}, -1);
  body.right_foot = Stand({}, 1);
  return body;
}

MadeBody Stepping(const Gait& gait, PlaceAt place, double seconds) {
  const Place now = place(seconds);
  MadeBody body;
  body.hips = now.at + Vec3{0, kStandingHips - 0.03f, 0};
  body.hips.y += Wave(0.015, seconds, gait.cycle_seconds / 2);
  body.yaw = now.yaw;
  body.left_foot = FootAt(gait, place, seconds, -1);
  body.right_foot = FootAt(gait, place, seconds, 1);
  return body;
}

MadeBody Idle(double seconds) {
  MadeBody body = Standing();
  body.hips += Vec3{Wave(0.03, seconds, 4.1), Wave(0.005, seconds, 3), 0};
  body.yaw = Wave(0.06, seconds, 7.3);
  body.bend = 0.03 + Wave(0.02, seconds, 5.2);
  body.left_arm.swing = Wave(0.08, seconds, 4.1);
  body.right_arm.swing = Wave(0.08, seconds, 4.7);
  return body;
}

// An eight of 3 m by 1.2 m every 14 s, half a metre a second and more.
Place EightPlace(double seconds) {
  const double turn = 2 * M_PI * seconds / 14;
  const double x = 1.5 * std::sin(turn), z = -0.6 * std::sin(2 * turn);
  const double along_x = 1.5 * std::cos(turn), along_z = -1.2 * std::cos(2 * turn);
  return {{static_cast<float>(x), 0, static_cast<float>(z)}, std::atan2(-along_x, -along_z)};
}

MadeBody WalkEight(double seconds) {
  const Gait gait = {1.1, 0.12};
  MadeBody body = Stepping(gait, EightPlace, seconds);
  body.bend = 0.05;
  body.left_arm.swing = Wave(0.45, seconds, gait.cycle_seconds);
  body.right_arm.swing = -body.left_arm.swing;
  return body;
}

Place DancePlace(double seconds) {
  return {{Wave(0.25, seconds, 4), 0, Wave(0.1, seconds, 8)}, Wave(0.5, seconds, 12)};
}

MadeBody Dance(double seconds) {
  MadeBody body = Stepping({1, 0.15}, DancePlace, seconds);
  body.bend = Wave(0.12, seconds, 2);
  body.left_arm = {1.4 + Wave(1.1, seconds, 2), 0.5, 0.6 + Wave(0.5, seconds, 1)};
  body.right_arm = {1.4 - Wave(1.1, seconds, 2), 0.5, 0.6 - Wave(0.5, seconds, 1)};
  return body;
}

// Down within 10 s and up again.
MadeBody Sit(double seconds) {
  const double down = 0.5 - 0.5 * std::cos(2 * M_PI * seconds / 10);
  MadeBody body = Standing();
  body.hips += Vec3{0, static_cast<float>(-0.36 * down), static_cast<float>(0.3 * down)};
  body.bend = 0.03 + 0.5 * std::sin(M_PI * down);
  body.left_arm.swing = body.right_arm.swing = 0.5 * down;
  body.left_arm.elbow = body.right_arm.elbow = 0.25 + 0.8 * down;
  return body;
}

// A leader whose pose depends only on the time.
template <MadeBody (*at)(double seconds)>
Poses Animate(double seconds, double rate) {
  Poses poses(0, motion::SbuSkeleton().joint_count());
  const int frames = static_cast<int>(std::lround(seconds * rate)) + 1;
  for (int t = 0; t < frames; ++t) poses.Append(PoseOf(at(t / rate)));
  return poses;
}

struct NamedLeader {
  const char* name;
  Poses (*make)(double seconds, double rate);
};
constexpr NamedLeader kLeaders[] = {{"idle", Animate<Idle>},
                                    {"walk_eight", Animate<WalkEight>},
                                    {"dance", Animate<Dance>},
                                    {"sit", Animate<Sit>}};

}  // namespace

Poses MakeLeader(const std::string& name, double seconds, double frame_rate_hz) {
  const auto* leader = std::find_if(std::begin(kLeaders), std::end(kLeaders),
                                    [&](const NamedLeader& other) { return name == other.name; });
  return leader->make(seconds, frame_rate_hz);
}

Poses StandingPerson() { return {motion::SbuSkeleton().joint_count(), PoseOf(Standing())}; }

}  // namespace duet::authoring
