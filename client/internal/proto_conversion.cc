#include "client/internal/proto_conversion.h"

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/request_id.h"
#include "model/base/text.h"

namespace duet::client::internal {
namespace {

absl::Status FillLeader(const motion::Clip& clip, v1::Motion* leader) {
  absl::Status status = FillFormat(clip.joint_names, clip.frame_rate_hz, leader);
  if (!status.ok()) return status;
  if (!clip.poses.empty() && clip.poses.joint_count() != clip.joint_count()) {
    return absl::InvalidArgumentError(
        absl::StrCat("leader.positions: expected poses of the ", clip.joint_count(),
                     " joints in leader.joint_names, got poses of ", clip.poses.joint_count()));
  }
  if (clip.poses.all().size() % clip.joint_names.size() != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("leader.positions: expected a multiple of ", clip.joint_names.size(),
                     " points (one for each frame and joint), got ", clip.poses.all().size()));
  }
  // The limit of protobuf: a message has at most 2 GiB.
  constexpr size_t kMaxPoints = (size_t{1} << 31) / 16;
  if (clip.poses.all().size() > kMaxPoints) {
    return absl::InvalidArgumentError(absl::StrCat("leader.positions: expected at most ",
                                                   kMaxPoints, " points, got ",
                                                   clip.poses.all().size()));
  }
  leader->set_frame_count(static_cast<uint32_t>(clip.frame_count()));
  AppendPositions(clip.poses.all(), leader->mutable_positions());
  return absl::OkStatus();
}

v1::Priority ToProto(Priority priority) {
  return priority == Priority::kBulk ? v1::PRIORITY_BULK : v1::PRIORITY_INTERACTIVE;
}

absl::Status Fill(const JointConstraint& constraint, int index, v1::JointConstraint* out) {
  if (constraint.frame < 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("constraints[", index, "].frame: expected 0 or more, got ", constraint.frame));
  }
  out->set_joint_name(constraint.joint);
  out->set_frame(static_cast<uint32_t>(constraint.frame));
  SetPoint(constraint.position, out->mutable_position());
  out->set_softness(constraint.softness);
  return absl::OkStatus();
}

bool HasJoint(const v1::Bone& bone, int joints) {
  const auto count = static_cast<uint32_t>(joints);
  return bone.parent_joint() < count && bone.child_joint() < count;
}

// Of the norm from 1; rounding to float gives 1e-7.
constexpr float kNormTolerance = 1e-3F;

template <typename... Parts>
absl::Status Invalid(const Parts&... parts) {
  return absl::InvalidArgumentError(absl::StrCat(parts...));
}

absl::Status CheckJoint(const std::string& field, const v1::RigJoint& joint, int index,
                        int joint_count) {
  const bool has_parent =
      index == 0 ? joint.parent() == -1 : joint.parent() >= 0 && joint.parent() < index;
  if (!has_parent) {
    return Invalid(field, ".parent: expected ",
                   index == 0 ? "-1" : absl::StrCat("0 to ", index - 1), ", got ", joint.parent());
  }
  if (joint.joint() >= static_cast<uint32_t>(joint_count)) {
    return Invalid(field, ".joint: expected 0 to ", joint_count - 1, ", got ", joint.joint());
  }
  const v1::Point& offset = joint.offset();
  if (!std::isfinite(offset.x()) || !std::isfinite(offset.y()) || !std::isfinite(offset.z())) {
    return Invalid(field, ".offset: expected finite values, got others");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::ModelSelector> ToProto(const ModelChoice& choice) {
  v1::ModelSelector selector;
  selector.set_name(choice.name);
  if (choice.version.has_value() && !choice.version_label.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("model: expected a version or a version label, got both: ", *choice.version,
                     " and \"", choice.version_label, "\""));
  }
  if (choice.version.has_value()) {
    if (*choice.version < 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("model.version: expected 1 or more, got ", *choice.version));
    }
    selector.set_version(static_cast<uint32_t>(*choice.version));
  }
  if (!choice.version_label.empty()) selector.set_version_label(choice.version_label);
  return selector;
}

absl::StatusOr<v1::SynthesizeRequest> ToProto(const SynthesisRequest& request) {
  v1::SynthesizeRequest out;
  absl::Status status = FillLeader(request.leader, out.mutable_leader());
  if (status.ok()) status = FillReaction(request, &out);
  if (!status.ok()) return status;
  out.set_priority(ToProto(request.priority));
  if (request.chunk_frames.has_value()) {
    if (*request.chunk_frames < 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("chunk_frames: expected 1 or more, got ", *request.chunk_frames));
    }
    out.set_chunk_frames(static_cast<uint32_t>(*request.chunk_frames));
  }
  for (const JointConstraint& constraint : request.constraints) {
    const int index = out.constraints_size();
    status = Fill(constraint, index, out.add_constraints());
    if (!status.ok()) return status;
  }
  return out;
}

absl::StatusOr<ModelInfo> FromProto(const v1::Model& model) {
  ModelInfo info;
  info.name = model.name();
  info.version = static_cast<int>(model.version());
  info.version_labels = {model.version_labels().begin(), model.version_labels().end()};
  info.is_default = model.is_default();
  info.interaction_classes = {model.interaction_classes().begin(),
                              model.interaction_classes().end()};
  info.joint_names = {model.joint_names().begin(), model.joint_names().end()};
  for (const v1::Bone& bone : model.bones()) {
    if (!HasJoint(bone, model.joint_names_size())) {
      return absl::InternalError(absl::StrCat("model.bones of ", model.name(), "@", model.version(),
                                              ": expected joints 0 to ",
                                              model.joint_names_size() - 1, ", got a bone from ",
                                              bone.parent_joint(), " to ", bone.child_joint()));
    }
    info.bones.push_back(
        {static_cast<int>(bone.parent_joint()), static_cast<int>(bone.child_joint())});
  }
  info.root_joint = model.root_joint();
  info.frame_rate_hz = model.frame_rate_hz();
  info.window_frames = static_cast<int>(model.window_frames());
  info.accepts_follower_start = model.accepts_follower_start();
  info.samples = model.samples();
  info.description = model.description();
  info.terms = model.terms();
  info.free_for_all_uses = model.free_for_all_uses();
  info.weights_sha256 = model.weights_sha256();
  return info;
}

RequestLimits FromProto(const v1::RequestLimits& limits) {
  RequestLimits out;
  out.min_frame_rate_hz = limits.min_frame_rate_hz();
  out.max_frame_rate_hz = limits.max_frame_rate_hz();
  out.min_frames = static_cast<int>(limits.min_frames());
  out.max_duration = absl::Seconds(limits.max_duration_seconds());
  out.max_chunk_frames = static_cast<int>(limits.max_chunk_frames());
  out.max_keyframes = static_cast<int>(limits.max_label_keyframes());
  out.max_abs_weight = limits.max_abs_weight();
  out.max_variety = limits.max_variety();
  out.max_candidates = static_cast<int>(limits.max_candidates());
  out.max_constraints = static_cast<int>(limits.max_constraints());
  out.max_request_bytes = static_cast<int64_t>(limits.max_request_bytes());
  return out;
}

MotionGrade FromProto(const v1::MotionGrade& grade) {
  MotionGrade out;
  out.twisted = grade.twisted();
  out.skating = grade.skating();
  out.leader_skating = grade.leader_skating();
  out.overlapping = grade.overlapping();
  for (const v1::FrameRun& run : grade.bad_runs()) {
    out.bad_runs.push_back(
        {static_cast<int>(run.first_frame()), static_cast<int>(run.frame_count())});
  }
  return out;
}

absl::Status FillFormat(const std::vector<std::string>& joint_names, double frame_rate_hz,
                        v1::Motion* leader) {
  if (joint_names.empty()) {
    return absl::InvalidArgumentError("leader.joint_names: expected the model's joints, got none");
  }
  leader->mutable_joint_names()->Assign(joint_names.begin(), joint_names.end());
  leader->set_frame_rate_hz(frame_rate_hz);
  leader->set_unit(v1::LENGTH_UNIT_METRES);
  leader->set_up_axis(v1::UP_AXIS_Y_UP);
  return absl::OkStatus();
}

void AppendPositions(absl::Span<const motion::Vec3> points,
                     google::protobuf::RepeatedField<float>* positions) {
  positions->Reserve(positions->size() + static_cast<int>(points.size()) * 3);
  for (const motion::Vec3& point : points) {
    positions->AddAlreadyReserved(point.x);
    positions->AddAlreadyReserved(point.y);
    positions->AddAlreadyReserved(point.z);
  }
}

void Fill(const std::vector<ClassWeight>& weights, v1::LabelVector* labels) {
  for (const ClassWeight& weight : weights) {
    v1::ClassWeight* out = labels->add_weights();
    out->set_interaction_class(weight.interaction_class);
    out->set_weight(weight.weight);
  }
}

void Fill(const FollowerStart& start, v1::FollowerStart* out) {
  if (const motion::Vec3* root = std::get_if<motion::Vec3>(&start)) {
    SetPoint(*root, out->mutable_root_position());
  } else {
    AppendPositions(std::get<std::vector<motion::Vec3>>(start),
                    out->mutable_pose()->mutable_positions());
  }
}

v1::CleanUp ToProto(std::optional<bool> clean_up) {
  if (!clean_up.has_value()) return v1::CLEAN_UP_UNSPECIFIED;
  return *clean_up ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF;
}

absl::Status Fill(const WeightKeyframe& keyframe, std::size_t index, v1::LabelKeyframe* out) {
  if (keyframe.frame < 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        "label_keyframes[", index, "].frame: expected 0 or more, got ", keyframe.frame));
  }
  out->set_frame(static_cast<uint32_t>(keyframe.frame));
  Fill(keyframe.weights, out->mutable_label_vector());
  return absl::OkStatus();
}

absl::Status CheckRequestId(const std::string& request_id) {
  if (request_id.empty()) return absl::OkStatus();
  const absl::Status status = base::CheckRequestId(request_id);
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat("request_id: ", status.message()));
}

std::vector<motion::Vec3> ToPoints(const google::protobuf::RepeatedField<float>& positions) {
  std::vector<motion::Vec3> points(static_cast<std::size_t>(positions.size()) / 3);
  const float* value = positions.data();
  for (motion::Vec3& point : points) {
    point = {value[0], value[1], value[2]};
    value += 3;
  }
  return points;
}

absl::StatusOr<std::vector<motion::RestJoint>> ReadRig(
    const std::string& field, const google::protobuf::RepeatedPtrField<v1::RigJoint>& rig,
    int joint_count) {
  std::vector<motion::RestJoint> joints;
  std::set<std::string> names;
  for (const v1::RigJoint& joint : rig) {
    const int index = static_cast<int>(joints.size());
    const std::string indexed = absl::StrCat(field, "[", index, "]");
    absl::Status status = CheckJoint(indexed, joint, index, joint_count);
    if (!status.ok()) return status;
    if (!names.insert(joint.name()).second) {
      return Invalid(indexed, ".name: expected a name once, got ", base::Quoted(joint.name()),
                     " again");
    }
    joints.push_back({joint.name(),
                      joint.parent(),
                      {joint.offset().x(), joint.offset().y(), joint.offset().z()},
                      static_cast<int>(joint.joint())});
  }
  return joints;
}

absl::Status CheckRotations(const std::string& field,
                            const google::protobuf::RepeatedField<float>& values,
                            std::size_t frames, std::size_t rig_joints) {
  const std::size_t wanted = frames * rig_joints * 4;
  if (static_cast<std::size_t>(values.size()) != wanted) {
    return Invalid(field, ": expected ", wanted, " values for ", frames, " frames, got ",
                   values.size());
  }
  for (int i = 0; i < values.size(); i += 4) {
    float squares = 0;
    for (int k = i; k < i + 4; ++k) squares += values[k] * values[k];
    // Negated, so that NaN is rejected.
    if (!(std::abs(std::sqrt(squares) - 1) <= kNormTolerance)) {
      return Invalid(field, "[", i, "..", i + 3, "]: expected a unit quaternion, got norm ",
                     std::sqrt(squares));
    }
  }
  return absl::OkStatus();
}

void AppendRotations(const google::protobuf::RepeatedField<float>& values,
                     std::vector<motion::UnitQuaternion>* rotations) {
  const float* value = values.data();
  for (int i = 0; i < values.size(); i += 4, value += 4) {
    rotations->push_back({value[0], value[1], value[2], value[3]});
  }
}

}  // namespace duet::client::internal
