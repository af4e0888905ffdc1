#ifndef DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_

#include <algorithm>
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
v1::CleanUp ToProto(std::optional<bool> clean_up);
// An empty ID is one that the server generates.
absl::Status CheckRequestId(const std::string& request_id);
// Also checks that the index is not negative.
absl::Status Fill(const WeightKeyframe& keyframe, std::size_t index, v1::LabelKeyframe* out);

template <typename Point>
void SetPoint(const motion::Vec3& from, Point* to) {
  to->set_x(from.x);
  to->set_y(from.y);
  to->set_z(from.z);
}

// Sets the joints, rate, unit and axis of a leader in metres, y up.
absl::Status FillFormat(const std::vector<std::string>& joint_names, double frame_rate_hz,
                        v1::Motion* leader);

// `request`: a SynthesisRequest for a SynthesizeRequest, or a LiveRequest for a LiveStart. Fills
// all fields that both have, except the leader.
template <typename Request, typename Message>
absl::Status FillReaction(const Request& request, Message* out) {
  absl::StatusOr<v1::ModelSelector> model = ToProto(request.model);
  if (!model.ok()) return model.status();
  *out->mutable_model() = *std::move(model);
  if (!request.weights.empty()) Fill(request.weights, out->mutable_label_vector());
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    absl::Status status = Fill(request.keyframes[i], i, out->add_label_keyframes());
    if (!status.ok()) return status;
  }
  if (request.follower_start.has_value()) {
    Fill(*request.follower_start, out->mutable_follower_start());
  }
  if (request.partner_direction.has_value()) {
    SetPoint(*request.partner_direction, out->mutable_partner_direction());
  }
  if (request.up.has_value()) SetPoint(*request.up, out->mutable_up());
  if (request.seed.has_value()) out->set_seed(*request.seed);
  out->set_reaction(request.reaction);
  out->set_variety(request.variety);
  if (request.candidates < 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("candidates: expected 1 or more, got ", request.candidates));
  }
  out->set_candidates(static_cast<uint32_t>(request.candidates));
  out->set_clean_up(ToProto(request.clean_up));
  out->set_reply_rotations(request.rotations);
  return absl::OkStatus();
}

// What the replies of clips and live sessions have in common. Errors: INVALID_ARGUMENT naming the
// field of the reply.

// Fails unless the header has the leader's joints and frame rate, and metres, y up.
template <typename Header>
absl::Status CheckHeader(const Header& header, const std::vector<std::string>& joint_names,
                         double frame_rate_hz) {
  if (!std::equal(header.joint_names().begin(), header.joint_names().end(), joint_names.begin(),
                  joint_names.end())) {
    return absl::InvalidArgumentError("header.joint_names differ from the leader's");
  }
  if (header.frame_rate_hz() != frame_rate_hz) {
    return absl::InvalidArgumentError(absl::StrCat("header.frame_rate_hz: expected the leader's ",
                                                   frame_rate_hz, ", got ",
                                                   header.frame_rate_hz()));
  }
  if (header.unit() == v1::LENGTH_UNIT_METRES && header.up_axis() == v1::UP_AXIS_Y_UP) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("header.unit and up_axis: expected metres, y up, got ",
                   v1::LengthUnit_Name(header.unit()), ", ", v1::UpAxis_Name(header.up_axis())));
}

// `info`: a SynthesisResult or a LiveInfo. Reads what the server chose.
template <typename Header, typename Info>
void ReadHeader(const Header& header, Info* info) {
  info->model_name = header.model_name();
  info->model_version = static_cast<int>(header.model_version());
  info->interaction_classes = {header.interaction_classes().begin(),
                               header.interaction_classes().end()};
  info->request_id = header.request_id();
  info->seed = header.seed();
  info->variety = header.variety();
  // Servers without candidates draw one sample and do not set the field.
  info->candidates = std::max(1, static_cast<int>(header.candidates()));
  info->cleaned_up = header.clean_up() == v1::CLEAN_UP_ON;
}

// Requires three coordinates for each point.
std::vector<motion::Vec3> ToPoints(const google::protobuf::RepeatedField<float>& positions);

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
