#include "server/service/validator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "model/engine/window_seed.h"
#include "server/service/request_fields.h"
#include "server/service/violations.h"

namespace duet::server::service {
namespace {

// The cosine of the largest angle between the true vertical and the up axis: 45 degrees.
constexpr float kMinUprightCosine = 0.70710678f;

// Validates one request. Each method adds the violations of one field.
class Validation {
 public:
  Validation(const v1::SynthesizeRequest& request, const engine::ModelDescription& model,
             const RequestLimits& limits, const RequestForm& form)
      : request_(request),
        model_(model),
        limits_(limits),
        label_frames_(form.label_frames),
        violations_(form.prefix) {}

  absl::StatusOr<ValidatedRequest> Run();

 private:
  void Leader();
  void Up();
  std::optional<engine::FollowerStart> Start();
  std::optional<motion::Vec3> PartnerDirection();
  // Returns a direction in metres, y up, as captured: its length is 0 if the caller's is. Absent,
  // with violations, if it is not finite; absent if the coordinates are unknown.
  std::optional<motion::Vec3> WorldDirection(absl::string_view field,
                                             const v1::Direction& direction);
  std::vector<motion::Vec3> StartPositions(absl::string_view field,
                                           const google::protobuf::RepeatedField<float>& values,
                                           const std::vector<int>& joints);
  void FillReplyMapping();
  void Rotations();
  int ChunkFrames();
  batching::Priority CallPriority();

  const v1::SynthesizeRequest& request_;
  const engine::ModelDescription& model_;
  const RequestLimits& limits_;
  const uint32_t label_frames_;
  Violations violations_;

  std::optional<motion::Coordinates> coordinates_;
  std::vector<int> joints_;  // the leader's joints in the model; empty if they do not match
  motion::Poses leader_;
  std::optional<motion::Levelling> levelling_;  // absent if the caller's world is level
  ReplyMapping reply_;
};

std::string Text(const v1::Direction& direction) {
  return absl::StrCat("(", direction.x(), ", ", direction.y(), ", ", direction.z(), ")");
}

void Validation::Leader() {
  if (!request_.has_leader()) {
    violations_.Malformed("leader", "a motion", "none");
    return;
  }
  const v1::Motion& leader = request_.leader();
  joints_ = ValidateJoints(leader, model_, violations_);
  ValidateTiming(leader, limits_, violations_);
  coordinates_ = ValidateCoordinates(leader, violations_);

  const bool finite = ValidateFinite("leader.positions", leader.positions(), violations_);
  if (!ValidateCount("leader.positions", leader.positions_size(), leader.frame_count(),
                     leader.joint_names_size(), violations_)) {
    return;
  }
  if (!finite || !coordinates_.has_value() || joints_.empty()) return;
  leader_ = ReadPositions("leader.positions", leader.positions(), joints_, *coordinates_, limits_,
                          violations_);
  ValidateSize("leader.positions", leader_, violations_);
}

void Validation::Up() {
  if (!request_.has_up()) return;
  const std::optional<motion::Vec3> up = WorldDirection("up", request_.up());
  if (!up.has_value()) return;
  // Negated, so that a direction of length 0 is rejected too.
  if (!(up->y > kMinUprightCosine * Norm(*up))) {
    violations_.Malformed(
        "up",
        absl::StrCat("a direction of any length but 0, less than 45 degrees from ",
                     v1::UpAxis_Name(request_.leader().up_axis())),
        Text(request_.up()));
    return;
  }
  levelling_ = motion::Levelling(*up, 0);
  leader_ = levelling_->Apply(std::move(leader_));
}

std::vector<motion::Vec3> Validation::StartPositions(
    absl::string_view field, const google::protobuf::RepeatedField<float>& values,
    const std::vector<int>& joints) {
  if (!ValidateFinite(field, values, violations_) || !coordinates_.has_value()) return {};
  motion::Poses pose = ReadPositions(field, values, joints, *coordinates_, limits_, violations_);
  if (levelling_.has_value()) pose = levelling_->Apply(std::move(pose));
  return {pose.all().begin(), pose.all().end()};
}

std::optional<engine::FollowerStart> Validation::Start() {
  if (!request_.has_follower_start()) return std::nullopt;
  if (!model_.accepts_follower_start) {
    violations_.Mismatch("follower_start",
                         absl::StrCat("no value for model ", model_.name, " version ",
                                      model_.version, ", which does not accept it"),
                         "one");
  }
  const v1::FollowerStart& start = request_.follower_start();
  if (start.has_root_position()) {
    google::protobuf::RepeatedField<float> xyz;
    for (const float value :
         {start.root_position().x(), start.root_position().y(), start.root_position().z()}) {
      xyz.Add(value);
    }
    const std::vector<motion::Vec3> root = StartPositions("follower_start.root_position", xyz, {0});
    if (root.empty()) return std::nullopt;
    return engine::FollowerStart{root.front(), {}};
  }
  if (!start.has_pose()) {
    violations_.Malformed("follower_start.start", "root_position or pose", "neither");
    return std::nullopt;
  }
  const auto& values = start.pose().positions();
  if (!ValidateCount("follower_start.pose.positions", values.size(), std::nullopt,
                     request_.leader().joint_names_size(), violations_) ||
      joints_.empty()) {
    return std::nullopt;
  }
  std::vector<motion::Vec3> pose = StartPositions("follower_start.pose.positions", values, joints_);
  if (pose.empty()) return std::nullopt;
  ValidateSize("follower_start.pose.positions", motion::Poses(static_cast<int>(pose.size()), pose),
               violations_);
  const motion::Vec3 root = pose[static_cast<std::size_t>(model_.skeleton.root)];
  return engine::FollowerStart{root, std::move(pose)};
}

std::optional<motion::Vec3> Validation::WorldDirection(absl::string_view field,
                                                       const v1::Direction& direction) {
  google::protobuf::RepeatedField<float> xyz;
  for (const float value : {direction.x(), direction.y(), direction.z()}) xyz.Add(value);
  if (!ValidateFinite(field, xyz, violations_) || !coordinates_.has_value()) return std::nullopt;
  // Scaled first, so that the conversion loses neither tiny nor huge components.
  const float largest = std::max({std::abs(xyz[0]), std::abs(xyz[1]), std::abs(xyz[2])});
  if (!(largest > 0)) return motion::Vec3{};
  const motion::Vec3 unit = {xyz[0] / largest, xyz[1] / largest, xyz[2] / largest};
  return ToWorld(*coordinates_, unit) - ToWorld(*coordinates_, {});
}

std::optional<motion::Vec3> Validation::PartnerDirection() {
  if (!request_.has_partner_direction()) return std::nullopt;
  const v1::Direction& direction = request_.partner_direction();
  const std::optional<motion::Vec3> captured = WorldDirection("partner_direction", direction);
  if (!captured.has_value()) return std::nullopt;
  const motion::Vec3 world = levelling_.has_value() ? levelling_->Apply(*captured) : *captured;
  const float horizontal = std::hypot(world.x, world.z);
  if (horizontal > 1e-6F * Norm(world)) {
    return motion::Vec3{world.x / horizontal, 0, world.z / horizontal};
  }
  violations_.Malformed("partner_direction", "a direction that is neither vertical nor of length 0",
                        Text(direction));
  return std::nullopt;
}

void Validation::FillReplyMapping() {
  const v1::Motion& leader = request_.leader();
  reply_.unit = leader.unit();
  reply_.up_axis = leader.up_axis();
  reply_.frame_rate_hz = leader.frame_rate_hz();
  if (coordinates_.has_value()) reply_.coordinates = *coordinates_;
  reply_.levelling = levelling_;
  const auto& wanted = request_.reply_joint_names();
  // The comparison below takes quadratic time, so a list that is too long is skipped.
  if (leader.joint_names_size() > kMaxJointNames) return;
  if (wanted.size() > leader.joint_names_size()) {
    violations_.Malformed(
        "reply_joint_names",
        absl::StrCat("at most the ", leader.joint_names_size(), " names of leader.joint_names"),
        absl::StrCat(wanted.size()));
    return;
  }
  for (const std::string& name : wanted.empty() ? leader.joint_names() : wanted) {
    reply_.joint_names.push_back(name);
    reply_.joints.push_back(model_.skeleton.Find(name));
  }
  const auto& known = leader.joint_names();
  for (int i = 0; i < wanted.size(); ++i) {
    const std::string field = absl::StrCat("reply_joint_names[", i, "]");
    if (std::find(known.begin(), known.end(), wanted[i]) == known.end()) {
      violations_.Malformed(field, "one of leader.joint_names", base::Quoted(wanted[i]));
    }
    const auto first = std::find(wanted.begin(), wanted.end(), wanted[i]);
    if (first - wanted.begin() < i) {
      violations_.Malformed(field, "each joint at most once",
                            absl::StrCat(base::Quoted(wanted[i]), " again after reply_joint_names[",
                                         first - wanted.begin(), "]"));
    }
  }
}

void Validation::Rotations() {
  if (!request_.reply_rotations()) return;
  if (request_.leader().unit() == v1::LENGTH_UNIT_SBU_NORMALISED) {
    violations_.Malformed(
        "reply_rotations",
        "LENGTH_UNIT_METRES or LENGTH_UNIT_MILLIMETRES in leader.unit: a unit that differs between "
        "axes has no rotations",
        "LENGTH_UNIT_SBU_NORMALISED");
  }
  if (request_.reply_joint_names_size() > 0) {
    violations_.Malformed("reply_rotations", "no reply_joint_names: a rig needs every joint",
                          absl::StrCat(request_.reply_joint_names_size(), " names"));
  }
  // Without frames, the leader has violations of its own.
  if (leader_.frame_count() == 0) return;
  reply_.rig = MakeRigSource(model_.skeleton, leader_, request_.leader().frame_rate_hz());
}

int Validation::ChunkFrames() {
  if (!request_.has_chunk_frames()) return limits_.default_chunk_frames;
  const uint32_t frames = request_.chunk_frames();
  if (frames < 1 || frames > static_cast<uint32_t>(limits_.max_chunk_frames)) {
    violations_.Malformed("chunk_frames", absl::StrCat("1 to ", limits_.max_chunk_frames),
                          absl::StrCat(frames));
  }
  return static_cast<int>(frames);
}

batching::Priority Validation::CallPriority() {
  const std::optional<batching::Priority> priority = PriorityOf(request_);
  if (priority.has_value()) return *priority;
  const std::string& name = v1::Priority_Name(request_.priority());
  violations_.Malformed("priority", "PRIORITY_INTERACTIVE, PRIORITY_BULK or no value",
                        name.empty() ? absl::StrCat(request_.priority()) : name);
  return batching::Priority::kInteractive;
}

absl::StatusOr<ValidatedRequest> Validation::Run() {
  Leader();
  Up();
  std::vector<engine::LabelKeyframe> labels =
      ValidateLabels(request_, label_frames_, model_, limits_, violations_);
  std::optional<engine::FollowerStart> start = Start();
  const std::optional<motion::Vec3> partner_direction = PartnerDirection();
  engine::SynthesisOptions options = ValidateOptions(request_, limits_, violations_);
  motion::Pins pins = ValidateConstraints(request_, {coordinates_, levelling_, leader_}, model_,
                                          limits_, violations_);
  FillReplyMapping();
  Rotations();
  const int chunk_frames = ChunkFrames();
  const batching::Priority priority = CallPriority();
  if (!violations_.empty()) return violations_.ToStatus();
  if (!request_.has_seed()) {
    options.sampling.seed =
        engine::LeaderSeed(leader_, request_.leader().frame_rate_hz(), model_.default_seeds);
  }
  return ValidatedRequest{
      {std::move(leader_), request_.leader().frame_rate_hz(), engine::LabelTrack(std::move(labels)),
       std::move(start), partner_direction, options, std::move(pins)},
      std::move(reply_),
      chunk_frames,
      priority};
}

}  // namespace

std::optional<batching::Priority> PriorityOf(const v1::SynthesizeRequest& request) {
  if (!request.has_priority()) return batching::Priority::kInteractive;
  switch (request.priority()) {
    case v1::PRIORITY_INTERACTIVE:
      return batching::Priority::kInteractive;
    case v1::PRIORITY_BULK:
      return batching::Priority::kBulk;
    default:
      return std::nullopt;
  }
}

absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits) {
  return ValidateRequest(request, model, limits, {"", request.leader().frame_count()});
}

absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits,
                                                 const RequestForm& form) {
  return Validation(request, model, limits, form).Run();
}

}  // namespace duet::server::service
