#include "client/analysis/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/body/limbs.h"
#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/body/penetration.h"
#include "model/body/posture.h"
#include "model/body/touch.h"
#include "model/cleanup/contacts.h"
#include "model/cleanup/floor.h"
#include "model/motion/body_part.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::client::analysis {
namespace {

using base::Index;

absl::Status Check(const char* name, const Answer& answer) {
  if (!answer.partner || answer.partner->frame_count() == answer.person.frame_count()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(name, ": partner: frames: expected ", answer.person.frame_count(),
                   " as the person has, got ", answer.partner->frame_count()));
}

// The poses of `clip` at a rate, the first `frames` of them.
motion::Poses AtRate(const motion::Clip& clip, double rate_hz, int frames) {
  motion::Poses poses(frames, clip.joint_count());
  for (int frame = 0; frame < frames; ++frame) {
    SampleLinear(clip.poses, frame * clip.frame_rate_hz / rate_hz, poses[frame]);
  }
  return poses;
}

double MeanDistance(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.all().size(); ++i) {
    sum += static_cast<double>(Distance(a.all()[i], b.all()[i]));
  }
  return sum / static_cast<double>(a.all().size());
}

motion::Poses AtRoot(motion::Poses poses, int root) {
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    const motion::Vec3 at = poses.at(frame, root);
    for (motion::Vec3& position : poses[frame]) position -= at;
  }
  return poses;
}

Displacement Displace(const motion::Poses& a, const motion::Poses& b,
                      const motion::Skeleton& skeleton, double rate_hz) {
  Displacement displacement;
  displacement.mean_metres = MeanDistance(a, b);
  displacement.root_aligned_metres =
      MeanDistance(AtRoot(a, skeleton.root), AtRoot(b, skeleton.root));
  displacement.joint_metres.resize(Index(skeleton.joint_count()));
  displacement.most_joint = skeleton.joint_names[0];
  for (int frame = 0; frame < a.frame_count(); ++frame) {
    for (int joint = 0; joint < a.joint_count(); ++joint) {
      const double distance = static_cast<double>(Distance(a.at(frame, joint), b.at(frame, joint)));
      displacement.joint_metres[Index(joint)] += distance / a.frame_count();
      if (distance <= displacement.most_metres) continue;
      displacement.most_metres = distance;
      displacement.most_joint = skeleton.joint_names[Index(joint)];
      displacement.most_frame = frame;
    }
  }
  displacement.root_metres = displacement.joint_metres[Index(skeleton.root)];
  if (a.frame_count() > 1) {
    displacement.velocity_metres_per_second = body::VelocityError(a, b, rate_hz);
  }
  return displacement;
}

// The share of the time that a foot stands, over both feet.
double StandingShare(const motion::Clip& clip, const motion::JointPair& feet) {
  const float floor = cleanup::FloorHeight(feet, clip.poses);
  double standing = 0;
  for (int joint : {feet.left, feet.right}) {
    std::vector<motion::Vec3> foot;
    for (int frame = 0; frame < clip.frame_count(); ++frame) foot.push_back(clip.at(frame, joint));
    for (const cleanup::Contact& contact : cleanup::FindContacts(foot, floor, clip.frame_rate_hz)) {
      standing += contact.end - contact.begin;
    }
  }
  return standing / (2.0 * clip.frame_count());
}

// The figures of one motion, in the order of kFigures below.
class Measurer {
 public:
  Measurer(const Answer& answer, const motion::Skeleton& skeleton)
      : person_(answer.person), skeleton_(skeleton) {
    if (answer.partner) partner_ = &*answer.partner;
  }

  std::vector<double> Measure() const {
    const motion::Poses& poses = person_.poses;
    const double rate = person_.frame_rate_hz;
    const body::Lean hips = body::MeasureLean(poses, skeleton_, rate, body::LeanFrom::kHips);
    const body::Lean feet = body::MeasureLean(poses, skeleton_, rate, body::LeanFrom::kFeet);
    std::vector<double> figures = {person_.frame_count() / rate,
                                   body::JointSpeed(poses, rate),
                                   body::JointSpeed(motion::WithoutNoise(poses, rate), rate),
                                   body::RangeOfMotion(poses),
                                   body::Jitter(poses, rate),
                                   hips.mean_degrees,
                                   hips.max_degrees,
                                   feet.max_degrees,
                                   body::BoneLengthDrift(poses, skeleton_),
                                   skeleton_.feet ? StandingShare(person_, *skeleton_.feet) : kNone,
                                   body::MeasureFootSlide(poses, skeleton_, rate).skating_ratio};
    const std::vector<double> with_partner = MeasureWithPartner();
    figures.insert(figures.end(), with_partner.begin(), with_partner.end());
    return figures;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::vector<double> MeasureWithPartner() const {
    if (partner_ == nullptr) return {kNone, kNone, kNone, kNone, kNone};
    const std::vector<motion::BodyPart> limbs = body::LimbParts(body::FindBody(skeleton_));
    const motion::Poses &partner = partner_->poses, &person = person_.poses;
    const body::Penetration penetration =
        body::MeasurePenetration(partner, person, skeleton_, limbs);
    return {body::RootDistance(partner, person, skeleton_),
            body::FacingDegrees(partner, person, skeleton_),
            body::TouchShare(partner, person, skeleton_, limbs), penetration.frequency,
            penetration.max_depth_metres};
  }

  const motion::Clip& person_;
  const motion::Clip* partner_ = nullptr;
  const motion::Skeleton& skeleton_;
};

struct FigureKind {
  const char *group, *name, *title, *unit;
};
constexpr FigureKind kFigures[] = {
    {"length", "duration_seconds", "duration", "s"},
    {"speed", "joint_speed_metres_per_second", "joint speed", "m/s"},
    {"speed", "filtered_joint_speed_metres_per_second", "joint speed without noise", "m/s"},
    {"speed", "range_of_motion_metres", "range of motion", "m"},
    {"speed", "jitter_metres_per_second_cubed", "jitter", "m/s\u00b3"},
    {"lean", "mean_lean_degrees", "lean from the hips, mean", "\u00b0"},
    {"lean", "lasting_lean_degrees", "lean from the hips, for a second", "\u00b0"},
    {"lean", "lasting_lean_from_feet_degrees", "lean from the feet, for a second", "\u00b0"},
    {"body", "bone_length_change", "bone lengths change by", ""},
    {"contact", "standing_share", "a foot stands, share of the time", ""},
    {"contact", "skating_share", "a standing foot slides, share of the time", ""},
    {"contact", "root_distance_metres", "distance to the partner", "m"},
    {"contact", "facing_degrees", "turned away from the partner", "\u00b0"},
    {"contact", "touch_share", "touches the partner, share of the time", ""},
    {"contact", "penetration_share", "reaches into the partner, share of the time", ""},
    {"contact", "penetration_metres", "reaches into the partner, at most", "m"},
};

std::optional<double> Known(double figure) {
  return std::isnan(figure) ? std::nullopt : std::optional<double>(figure);
}

std::vector<Figure> MeasureBoth(const Answer& a, const Answer& b,
                                const motion::Skeleton& skeleton) {
  const std::vector<double> of_a = Measurer(a, skeleton).Measure();
  const std::vector<double> of_b = Measurer(b, skeleton).Measure();
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const FigureKind& kind = kFigures[i];
    figures.push_back(
        {kind.group, kind.name, kind.title, kind.unit, Known(of_a[i]), Known(of_b[i])});
  }
  return figures;
}

}  // namespace

absl::StatusOr<Comparison> Compare(const Answer& a, const Answer& b,
                                   const motion::Skeleton& skeleton) {
  absl::Status status = Check("a", a);
  if (status.ok()) status = Check("b", b);
  if (!status.ok()) return status;
  Comparison comparison;
  const double rate = comparison.frame_rate_hz = a.person.frame_rate_hz;
  comparison.resampled = b.person.frame_rate_hz != rate;
  // Rounding of rates does not cost a frame.
  const double b_frames =
      std::floor((b.person.frame_count() - 1) * rate / b.person.frame_rate_hz + 1e-6) + 1;
  const int frames = comparison.frame_count =
      static_cast<int>(std::min(static_cast<double>(a.person.frame_count()), b_frames));
  comparison.displacement =
      Displace(AtRate(a.person, rate, frames), AtRate(b.person, rate, frames), skeleton, rate);
  if (a.partner && b.partner) {
    comparison.partner_metres =
        MeanDistance(AtRate(*a.partner, rate, frames), AtRate(*b.partner, rate, frames));
  }
  comparison.figures = MeasureBoth(a, b, skeleton);
  return comparison;
}

}  // namespace duet::client::analysis
