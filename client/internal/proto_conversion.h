#ifndef DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "client/request.h"
#include "client/result.h"
#include "duet/v1/motion.pb.h"
#include "duet/v1/reaction.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "google/protobuf/repeated_field.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/vec3.h"

namespace duet::client::internal {

// Convert values to protos. Return INVALID_ARGUMENT, naming the field, only for values that the
// proto cannot represent. The server validates everything else.
absl::StatusOr<v1::ModelSelector> ToProto(const ModelChoice& choice);
absl::StatusOr<v1::SynthesizeRequest> ToProto(const SynthesisRequest& request);

// Convert protos to values. Return INTERNAL if the server's model is inconsistent.
absl::StatusOr<ModelInfo> FromProto(const v1::Model& model);
RequestLimits FromProto(const v1::RequestLimits& limits);
MotionGrade FromProto(const v1::MotionGrade& grade);

// The fields that SynthesizeRequest and LiveStart have in common. Errors: INVALID_ARGUMENT, naming
// the field, only for values that neither the proto nor the metadata of a call can represent.

void AppendPositions(absl::Span<const motion::Vec3> points,
                     google::protobuf::RepeatedField<float>* positions);
void Fill(const std::vector<ClassWeight>& weights, v1::LabelVector* labels);
void Fill(const FollowerStart& start, v1::FollowerStart* out);
void Fill(const motion::Vec3& direction, v1::Direction* out);
v1::CleanUp ToProto(std::optional<bool> clean_up);
// An empty ID is one that the server generates.
absl::Status CheckRequestId(const std::string& request_id);
// Also checks that the index is not negative.
absl::Status Fill(const WeightKeyframe& keyframe, std::size_t index, v1::LabelKeyframe* out);

template <typename Message>
absl::Status FillLabels(const std::vector<ClassWeight>& weights,
                        const std::vector<WeightKeyframe>& keyframes, Message* out) {
  if (!weights.empty()) Fill(weights, out->mutable_label_vector());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    absl::Status status = Fill(keyframes[i], i, out->add_label_keyframes());
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

template <typename Message>
absl::Status FillReaction(const ReactionOptions& options, Message* out) {
  if (options.partner_direction.has_value()) {
    Fill(*options.partner_direction, out->mutable_partner_direction());
  }
  if (options.up.has_value()) Fill(*options.up, out->mutable_up());
  if (options.seed.has_value()) out->set_seed(*options.seed);
  out->set_reaction(options.reaction);
  out->set_variety(options.variety);
  if (options.candidates < 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("candidates: expected 1 or more, got ", options.candidates));
  }
  out->set_candidates(static_cast<uint32_t>(options.candidates));
  out->set_clean_up(ToProto(options.clean_up));
  return absl::OkStatus();
}

// The rig and the rotations of a reply. Errors: INVALID_ARGUMENT naming the field of the reply.

// `field`: that of the rig in the reply. Fails unless the first joint is the only root, every
// parent comes before its children, names are unique, offsets are finite, and joints are in [0,
// joint_count).
absl::StatusOr<std::vector<motion::RestJoint>> ReadRig(
    const std::string& field, const google::protobuf::RepeatedPtrField<v1::RigJoint>& rig,
    int joint_count);

// Fails unless `values` has a unit quaternion for each of `frames` and each of `rig_joints`.
absl::Status CheckRotations(const std::string& field,
                            const google::protobuf::RepeatedField<float>& values,
                            std::size_t frames, std::size_t rig_joints);

// Requires values that CheckRotations accepts.
void AppendRotations(const google::protobuf::RepeatedField<float>& values,
                     std::vector<motion::UnitQuaternion>* rotations);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
