#include "client/batch/quality.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "model/body/limbs.h"
#include "model/body/liveliness.h"
#include "model/body/penetration.h"
#include "model/body/posture.h"
#include "model/motion/feet.h"

namespace duet::client::batch {
namespace {

// The clip reduced to these joints, in this order.
motion::Clip InJoints(const motion::Clip& clip, const std::vector<std::string>& joints) {
  if (clip.joint_names == joints) return clip;
  std::vector<int> from;
  for (const std::string& joint : joints) {
    const auto found = std::find(clip.joint_names.begin(), clip.joint_names.end(), joint);
    from.push_back(static_cast<int>(found - clip.joint_names.begin()));
  }
  motion::Clip out;
  out.joint_names = joints;
  out.frame_rate_hz = clip.frame_rate_hz;
  out.poses = motion::Poses(clip.frame_count(), static_cast<int>(joints.size()));
  for (int t = 0; t < clip.frame_count(); ++t) {
    for (size_t j = 0; j < from.size(); ++j) out.at(t, static_cast<int>(j)) = clip.at(t, from[j]);
  }
  return out;
}

}  // namespace

Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton,
                const SynthesisResult& result) {
  const motion::Poses& leader = pair.leader.poses;
  const motion::Poses& follower = pair.follower.poses;
  Quality quality;
  std::map<std::string, double>& figures = quality.figures;
  const double lean =
      body::MeasureLean(follower, skeleton, pair.follower.frame_rate_hz, body::LeanFrom::kHips)
          .max_degrees;
  if (!std::isnan(lean)) figures["lean_degrees"] = lean;
  if (skeleton.feet.has_value()) {
    const body::FloorGap gap =
        body::MeasureFloorGap(follower, skeleton, motion::FloorHeight(*skeleton.feet, leader));
    figures["foot_above_floor_metres"] = gap.above;
    figures["foot_below_floor_metres"] = gap.below;
  }
  figures["distance_metres"] = body::RootDistance(leader, follower, skeleton);
  figures["penetration_metres"] =
      body::MeasurePenetration(leader, follower, skeleton,
                               body::LimbParts(body::FindBody(skeleton)))
          .max_depth_metres;
  figures["range_of_motion_metres"] = body::RangeOfMotion(follower);
  if (result.grade.has_value()) {
    figures["twisted"] = result.grade->twisted;
    figures["skating"] = result.grade->skating;
    figures["leader_skating"] = result.grade->leader_skating;
    figures["overlapping"] = result.grade->overlapping;
  }
  quality.unfamiliarity = result.unfamiliarity;
  return quality;
}

void Recognise(const classifier::Classifier& classifier, const std::string& wanted,
               const motion::ClipPair& pair, Quality* quality) {
  const classifier::ClassifierParts& parts = classifier.parts();
  const auto known = std::find(parts.classes.begin(), parts.classes.end(), wanted);
  if (known == parts.classes.end()) return;
  const std::vector<std::string>& joints = parts.skeleton.joint_names;
  const std::vector<float> probabilities =
      classifier.Probabilities({InJoints(pair.leader, joints), InJoints(pair.follower, joints)});
  const auto best = std::max_element(probabilities.begin(), probabilities.end());
  quality->recognised_class = parts.classes[static_cast<size_t>(best - probabilities.begin())];
  quality->figures["class_probability"] =
      probabilities[static_cast<size_t>(known - parts.classes.begin())];
}

std::vector<std::string> WhyRejected(const v1::QualityFilter& filter, const Quality& quality) {
  std::map<std::string, double> figures = quality.figures;
  if (quality.unfamiliarity) figures["unfamiliarity"] = *quality.unfamiliarity;
  if (figures.count("skating") > 0) {
    figures["skating_over_leader"] = figures["skating"] - figures["leader_skating"];
  }
  std::vector<std::string> reasons;
  const auto check = [&](absl::string_view limit_name, double limit) {
    const std::string name(limit_name.substr(4));  // without max_ or min_
    const auto found = figures.find(name);
    if (found == figures.end()) return;
    const bool at_most = absl::StartsWith(limit_name, "max_");
    if (at_most ? found->second <= limit : found->second >= limit) return;
    reasons.push_back(absl::StrFormat("%s: expected at %s %g, got %.4g", name,
                                      at_most ? "most" : "least", limit, found->second));
  };
  std::vector<const google::protobuf::FieldDescriptor*> limits;
  filter.GetReflection()->ListFields(filter, &limits);
  for (const google::protobuf::FieldDescriptor* limit : limits) {
    if (limit->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    check(limit->name(), filter.GetReflection()->GetDouble(filter, limit));
  }
  if (filter.has_classifier()) {
    check("min_class_probability", filter.classifier().min_probability());
  }
  return reasons;
}

}  // namespace duet::client::batch
