#include "client/cli/request_file.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.pb.h"
#include "model/base/file.h"
#include "model/messages/message_text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::cli {
namespace {

template <typename Point>
motion::Vec3 FromProto(const Point& point) {
  return {point.x(), point.y(), point.z()};
}

std::vector<motion::Vec3> ToPoints(const google::protobuf::RepeatedField<float>& positions) {
  std::vector<motion::Vec3> points;
  for (int i = 0; i + 2 < positions.size(); i += 3) {
    points.push_back({positions[i], positions[i + 1], positions[i + 2]});
  }
  return points;
}

absl::Status Expected(const char* field, const std::string& expected, const std::string& got) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": expected ", expected, ", got ", got));
}

absl::StatusOr<motion::Clip> FromProto(const v1::Motion& leader) {
  if (leader.unit() != v1::LENGTH_UNIT_METRES) {
    return Expected("leader.unit", "LENGTH_UNIT_METRES", v1::LengthUnit_Name(leader.unit()));
  }
  if (leader.up_axis() != v1::UP_AXIS_Y_UP) {
    return Expected("leader.up_axis", "UP_AXIS_Y_UP", v1::UpAxis_Name(leader.up_axis()));
  }
  const std::size_t floats =
      std::size_t{leader.frame_count()} * 3 * static_cast<std::size_t>(leader.joint_names_size());
  if (static_cast<std::size_t>(leader.positions_size()) != floats) {
    return Expected("leader.positions",
                    absl::StrCat(floats, " values (3 for each joint and frame)"),
                    absl::StrCat(leader.positions_size()));
  }
  motion::Clip clip;
  clip.joint_names = {leader.joint_names().begin(), leader.joint_names().end()};
  clip.frame_rate_hz = leader.frame_rate_hz();
  clip.poses = motion::Poses(leader.joint_names_size(), ToPoints(leader.positions()));
  return clip;
}

std::vector<ClassWeight> FromProto(const v1::LabelVector& labels) {
  std::vector<ClassWeight> weights;
  for (const v1::ClassWeight& weight : labels.weights()) {
    weights.push_back({weight.interaction_class(), weight.weight()});
  }
  return weights;
}

ModelChoice FromProto(const v1::ModelSelector& selector) {
  ModelChoice choice;
  choice.name = selector.name();
  if (selector.has_version()) choice.version = static_cast<int>(selector.version());
  choice.version_label = selector.version_label();
  return choice;
}

absl::Status FillOptions(const v1::SynthesizeRequest& in, SynthesisOptions* out) {
  if (in.has_partner_direction()) out->partner_direction = FromProto(in.partner_direction());
  if (in.has_up()) out->up = FromProto(in.up());
  if (in.has_seed()) out->seed = in.seed();
  if (in.has_variety()) out->variety = in.variety();
  if (in.has_reaction()) out->reaction = in.reaction();
  if (in.has_candidates()) out->candidates = static_cast<int>(in.candidates());
  if (in.clean_up() != v1::CLEAN_UP_UNSPECIFIED) out->clean_up = in.clean_up() == v1::CLEAN_UP_ON;
  out->rotations = in.reply_rotations();
  if (in.has_priority()) {
    if (in.priority() == v1::PRIORITY_UNSPECIFIED) {
      return Expected("priority", "PRIORITY_INTERACTIVE or PRIORITY_BULK", "PRIORITY_UNSPECIFIED");
    }
    if (in.priority() == v1::PRIORITY_BULK) out->priority = Priority::kBulk;
  }
  if (in.has_chunk_frames()) out->chunk_frames = static_cast<int>(in.chunk_frames());
  for (const v1::JointConstraint& constraint : in.constraints()) {
    out->constraints.push_back({constraint.joint_name(), static_cast<int>(constraint.frame()),
                                FromProto(constraint.position()), constraint.softness()});
  }
  return absl::OkStatus();
}

absl::StatusOr<SynthesisRequest> FromProto(const v1::SynthesizeRequest& in) {
  if (in.reply_joint_names_size() > 0) {
    return Expected("reply_joint_names", "none: every output needs all joints",
                    absl::StrCat(in.reply_joint_names_size()));
  }
  SynthesisRequest out;
  const absl::Status options = FillOptions(in, &out);
  if (!options.ok()) return options;
  out.model = FromProto(in.model());
  if (in.has_leader()) {
    absl::StatusOr<motion::Clip> leader = FromProto(in.leader());
    if (!leader.ok()) return leader.status();
    out.leader = *std::move(leader);
  }
  out.weights = FromProto(in.label_vector());
  for (const v1::LabelKeyframe& keyframe : in.label_keyframes()) {
    out.keyframes.push_back(
        {static_cast<int>(keyframe.frame()), FromProto(keyframe.label_vector())});
  }
  if (in.follower_start().has_root_position()) {
    out.follower_start = FromProto(in.follower_start().root_position());
  } else if (in.follower_start().has_pose()) {
    out.follower_start = ToPoints(in.follower_start().pose().positions());
  }
  return out;
}

absl::Status InFile(const std::filesystem::path& file, const absl::Status& status) {
  return {status.code(), absl::StrCat(file.string(), ": ", status.message())};
}

}  // namespace

absl::StatusOr<SynthesisRequest> ReadRequestFile(const std::filesystem::path& file) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, motion::kMaxMotionFileBytes, "a request");
  if (!text.ok()) return text.status();
  v1::SynthesizeRequest message;
  const absl::Status parsed =
      messages::ParseMessage(*text, messages::MessageSyntax::kTextFormat, &message);
  if (!parsed.ok()) return InFile(file, parsed);
  absl::StatusOr<SynthesisRequest> request = FromProto(message);
  if (!request.ok()) return InFile(file, request.status());
  return request;
}

}  // namespace duet::client::cli
