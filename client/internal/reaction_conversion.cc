#include "client/internal/reaction_conversion.h"

#include <variant>

#include "model/base/request_id.h"

namespace duet::client::internal {

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
    out->mutable_root_position()->set_x(root->x);
    out->mutable_root_position()->set_y(root->y);
    out->mutable_root_position()->set_z(root->z);
  } else {
    AppendPositions(std::get<std::vector<motion::Vec3>>(start),
                    out->mutable_pose()->mutable_positions());
  }
}

void Fill(const motion::Vec3& direction, v1::Direction* out) {
  out->set_x(direction.x);
  out->set_y(direction.y);
  out->set_z(direction.z);
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

}  // namespace duet::client::internal
