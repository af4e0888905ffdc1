#include "server/service/validator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "model/engine/candidates.h"
#include "model/engine/windows.h"
#include "server/service/request_fields.h"

namespace duet::server::service {
namespace {

using absl::StrCat;
using motion::Vec3;

static_assert(RequestLimits().max_candidates == engine::kMostCandidates);

// The cosine of the largest angle between the true vertical and the up axis: 45 degrees.
constexpr float kMinUprightCosine = 0.70710678f;

// Validates one request. Each method adds the violations of one field.
class Validation {
 public:
  Validation(const v1::SynthesizeRequest& request, const engine::ModelDescription& model,
             const RequestLimits& limits, std::string prefix, uint32_t label_frames)
      : request_(request),
        model_(model),
        limits_(limits),
        label_frames_(label_frames),
        fields_(model, limits, std::move(prefix)) {}

  absl::StatusOr<ValidatedRequest> Run() {
    Leader();
    Up();
    std::vector<engine::LabelKeyframe> labels = Labels();
    std::optional<engine::FollowerStart> start = Start();
    const std::optional<Vec3> partner_direction = PartnerDirection();
    engine::SynthesisOptions options = Options();
    motion::Pins pins = Constraints();
    FillReplyMapping();
    Rotations();
    const int chunk_frames = ChunkFrames();
    const batching::Priority priority = CallPriority();
    if (!fields_.violations().empty()) return fields_.violations().ToStatus();
    if (!request_.has_seed()) {
      options.sampling.seed =
          engine::LeaderSeed(leader_, request_.leader().frame_rate_hz(), model_.default_seeds);
    }
    return ValidatedRequest{{std::move(leader_), request_.leader().frame_rate_hz(),
                             engine::LabelTrack(std::move(labels)), std::move(start),
                             partner_direction, options, std::move(pins)},
                            std::move(reply_),
                            chunk_frames,
                            priority};
  }

 private:
  void Leader() {
    if (!request_.has_leader()) return Malformed("leader", "a motion", "none");
    const v1::Motion& leader = request_.leader();
    format_.joint_count = leader.joint_names_size();
    format_.joints = fields_.Joints(leader);
    fields_.Timing(leader);
    format_.coordinates = fields_.Coordinates(leader);
    leader_ =
        fields_.Positions("leader.positions", leader.positions(), leader.frame_count(), format_);
    fields_.Size("leader.positions", leader_);
  }

  void Up() {
    if (!request_.has_up()) return;
    const std::optional<Vec3> up = WorldDirection("up", request_.up());
    if (!up.has_value()) return;
    // Negated, so that a direction of length 0 is rejected too.
    if (!(up->y > kMinUprightCosine * Norm(*up))) {
      return Malformed("up",
                       StrCat("a direction of any length but 0, less than 45 degrees from ",
                              v1::UpAxis_Name(request_.leader().up_axis())),
                       XyzText(request_.up()));
    }
    levelling_ = motion::Levelling(*up, 0);
    leader_ = levelling_->Apply(std::move(leader_));
  }

  std::vector<engine::LabelKeyframe> Labels() {
    const bool has_keyframes = !request_.label_keyframes().empty();
    if (request_.has_label_vector() == has_keyframes) {
      Malformed(has_keyframes ? "label_keyframes" : "label_vector",
                "label_vector or label_keyframes", has_keyframes ? "both" : "neither");
    }
    std::vector<engine::LabelKeyframe> keyframes = LabelKeyframes();
    if (request_.has_label_vector()) {
      keyframes.push_back({0, fields_.LabelVector("label_vector", request_.label_vector())});
    }
    return keyframes;
  }

  std::vector<engine::LabelKeyframe> LabelKeyframes() {
    std::vector<engine::LabelKeyframe> keyframes;
    const int count = request_.label_keyframes_size();
    if (!fields_.AtMost("label_keyframes", limits_.max_label_keyframes, count)) return keyframes;
    for (int i = 0; i < count; ++i) {
      const v1::LabelKeyframe& keyframe = request_.label_keyframes(i);
      const std::string at = StrCat("label_keyframes[", i, "]");
      const std::string frame = StrCat(keyframe.frame());
      if (keyframe.frame() >= label_frames_) {
        Malformed(at + ".frame", StrCat("less than ", label_frames_, ", the number of frames"),
                  frame);
      }
      if (i > 0 && keyframe.frame() <= request_.label_keyframes(i - 1).frame()) {
        Malformed(
            at + ".frame",
            StrCat("more than the previous keyframe's ", request_.label_keyframes(i - 1).frame()),
            frame);
      }
      keyframes.push_back({static_cast<int>(std::min(keyframe.frame(), label_frames_)),
                           fields_.LabelVector(at + ".label_vector", keyframe.label_vector())});
    }
    return keyframes;
  }

  std::optional<engine::FollowerStart> Start() {
    if (!request_.has_follower_start()) return std::nullopt;
    if (!model_.accepts_follower_start) {
      fields_.violations().Mismatch("follower_start",
                                    StrCat("no value for model ", model_.name, " version ",
                                           model_.version, ", which does not accept it"),
                                    "one");
    }
    const v1::FollowerStart& start = request_.follower_start();
    if (start.has_root_position()) {
      const std::vector<Vec3> root =
          StartPositions("follower_start.root_position", Components(start.root_position()),
                         {1, {0}, format_.coordinates});
      if (root.empty()) return std::nullopt;
      return engine::FollowerStart{root.front(), {}};
    }
    if (!start.has_pose()) {
      Malformed("follower_start.start", "root_position or pose", "neither");
      return std::nullopt;
    }
    constexpr char kField[] = "follower_start.pose.positions";
    std::vector<Vec3> pose = StartPositions(kField, start.pose().positions(), format_);
    if (pose.empty()) return std::nullopt;
    fields_.Size(kField, motion::Poses(static_cast<int>(pose.size()), pose));
    const Vec3 root = pose[static_cast<std::size_t>(model_.skeleton.root)];
    return engine::FollowerStart{root, std::move(pose)};
  }

  std::optional<Vec3> PartnerDirection() {
    if (!request_.has_partner_direction()) return std::nullopt;
    const v1::Direction& direction = request_.partner_direction();
    const std::optional<Vec3> captured = WorldDirection("partner_direction", direction);
    if (!captured.has_value()) return std::nullopt;
    const Vec3 world = levelling_.has_value() ? levelling_->Apply(*captured) : *captured;
    const float horizontal = std::hypot(world.x, world.z);
    if (horizontal > 1e-6F * Norm(world)) {
      return Vec3{world.x / horizontal, 0, world.z / horizontal};
    }
    Malformed("partner_direction", "a direction that is neither vertical nor of length 0",
              XyzText(direction));
    return std::nullopt;
  }

  // Returns a direction in metres, y up, as captured: its length is 0 if the caller's is. Absent,
  // with violations, if it is not finite; absent if the coordinates are unknown.
  std::optional<Vec3> WorldDirection(absl::string_view field, const v1::Direction& direction) {
    const google::protobuf::RepeatedField<float> xyz = Components(direction);
    if (!fields_.Finite(field, xyz) || !format_.coordinates.has_value()) return std::nullopt;
    // Scaled first, so that the conversion loses neither tiny nor huge components.
    const float largest = std::max({std::abs(xyz[0]), std::abs(xyz[1]), std::abs(xyz[2])});
    if (!(largest > 0)) return Vec3{};
    const Vec3 unit = {xyz[0] / largest, xyz[1] / largest, xyz[2] / largest};
    return ToWorld(*format_.coordinates, unit) - ToWorld(*format_.coordinates, {});
  }

  std::vector<Vec3> StartPositions(absl::string_view field,
                                   const google::protobuf::RepeatedField<float>& values,
                                   const PositionFormat& format) {
    motion::Poses pose = fields_.Positions(field, values, std::nullopt, format);
    if (levelling_.has_value()) pose = levelling_->Apply(std::move(pose));
    return {pose.all().begin(), pose.all().end()};
  }

  engine::SynthesisOptions Options() {
    engine::SynthesisOptions options;
    engine::Sampling& sampling = options.sampling;
    if (request_.has_seed()) sampling.seed = request_.seed();
    if (request_.has_variety()) sampling.variety = request_.variety();
    fields_.Number("variety", sampling.variety, 0, limits_.max_variety);
    if (request_.has_reaction()) sampling.reaction = request_.reaction();
    fields_.Number("reaction", sampling.reaction, 0, engine::kMostReaction);
    sampling.candidates = engine::kDefaultCandidates;
    if (request_.has_candidates() &&
        fields_.Whole("candidates", request_.candidates(), 1, limits_.max_candidates)) {
      sampling.candidates = static_cast<int>(request_.candidates());
    }
    options.clean_up = CleanUp();
    return options;
  }

  std::optional<bool> CleanUp() {
    switch (request_.clean_up()) {
      case v1::CLEAN_UP_ON:
        return true;
      case v1::CLEAN_UP_OFF:
        return false;
      case v1::CLEAN_UP_UNSPECIFIED:
        break;
      default:
        Malformed("clean_up", "CLEAN_UP_ON, CLEAN_UP_OFF or no value", StrCat(request_.clean_up()));
    }
    return std::nullopt;
  }

  // The constraints as pins in the caller's frames, the model's joints and level world metres, in
  // the same order.
  motion::Pins Constraints() {
    motion::Pins pins;
    const int count = request_.constraints_size();
    if (!fields_.AtMost("constraints", limits_.max_constraints, count)) return pins;
    for (int i = 0; i < count; ++i) {
      const v1::JointConstraint& constraint = request_.constraints(i);
      const std::string at = StrCat("constraints[", i, "].");
      ConstraintRepetition(i);
      if (constraint.frame() >= request_.leader().frame_count()) {
        Malformed(at + "frame",
                  StrCat("less than the ", request_.leader().frame_count(), " frames of leader"),
                  StrCat(constraint.frame()));
      }
      fields_.Number(at + "softness", constraint.softness(), 0, 1);
      const int joint = model_.skeleton.Find(constraint.joint_name());
      if (joint < 0) {
        fields_.violations().Mismatch(at + "joint_name",
                                      StrCat("a joint of model ", model_.name, " (",
                                             absl::StrJoin(model_.skeleton.joint_names, ", "), ")"),
                                      base::Quoted(constraint.joint_name()));
      }
      pins.push_back({joint, static_cast<double>(constraint.frame()),
                      ConstraintPosition(at + "position", constraint), constraint.softness()});
    }
    return pins;
  }

  Vec3 ConstraintPosition(const std::string& field, const v1::JointConstraint& constraint) {
    if (!constraint.has_position()) {
      Malformed(field, "a point", "none");
      return {};
    }
    const v1::Point& point = constraint.position();
    const Vec3 given = {point.x(), point.y(), point.z()};
    if (!IsFinite(given)) {
      Malformed(field, "finite numbers", XyzText(point));
      return {};
    }
    if (!format_.coordinates) return {};
    const Vec3 captured = ToWorld(*format_.coordinates, given);
    const Vec3 position = levelling_ ? levelling_->Apply(captured) : captured;
    if (constraint.frame() >= static_cast<uint32_t>(leader_.frame_count())) return position;
    const Vec3 root = leader_.at(static_cast<int>(constraint.frame()), model_.skeleton.root);
    // Negated, so that a conversion that overflowed is rejected too.
    if (!(Distance(position, root) <= limits_.max_constraint_metres)) {
      Malformed(field,
                StrCat("at most ", limits_.max_constraint_metres,
                       " m from the leader in this frame, in leader.unit"),
                StrCat(XyzText(point), "; check the unit"));
    }
    return position;
  }

  // Takes time in proportion to `index`; the number of constraints is limited.
  void ConstraintRepetition(int index) {
    const v1::JointConstraint& constraint = request_.constraints(index);
    for (int i = 0; i < index; ++i) {
      const v1::JointConstraint& earlier = request_.constraints(i);
      if (earlier.frame() != constraint.frame() ||
          earlier.joint_name() != constraint.joint_name()) {
        continue;
      }
      return Malformed(StrCat("constraints[", index, "]"), "each joint at most once in a frame",
                       StrCat(base::Quoted(constraint.joint_name()), " in frame ",
                              constraint.frame(), " again after constraints[", i, "]"));
    }
  }

  void FillReplyMapping() {
    const v1::Motion& leader = request_.leader();
    reply_.unit = leader.unit();
    reply_.up_axis = leader.up_axis();
    reply_.frame_rate_hz = leader.frame_rate_hz();
    if (format_.coordinates.has_value()) reply_.coordinates = *format_.coordinates;
    reply_.levelling = levelling_;
    // ReplyJoints takes quadratic time, so a list that is too long is skipped.
    if (leader.joint_names_size() <= kMaxJointNames) ReplyJoints();
  }

  void ReplyJoints() {
    const auto& wanted = request_.reply_joint_names();
    const auto& known = request_.leader().joint_names();
    if (wanted.size() > known.size()) {
      return Malformed("reply_joint_names",
                       StrCat("at most the ", known.size(), " names of leader.joint_names"),
                       StrCat(wanted.size()));
    }
    for (const std::string& name : wanted.empty() ? known : wanted) {
      reply_.joint_names.push_back(name);
      reply_.joints.push_back(model_.skeleton.Find(name));
    }
    for (int i = 0; i < wanted.size(); ++i) {
      const std::string field = StrCat("reply_joint_names[", i, "]");
      if (std::find(known.begin(), known.end(), wanted[i]) == known.end()) {
        Malformed(field, "one of leader.joint_names", base::Quoted(wanted[i]));
      }
      const auto first = std::find(wanted.begin(), wanted.end(), wanted[i]) - wanted.begin();
      if (first < i) {
        Malformed(field, "each joint at most once",
                  StrCat(base::Quoted(wanted[i]), " again after reply_joint_names[", first, "]"));
      }
    }
  }

  void Rotations() {
    if (!request_.reply_rotations()) return;
    if (request_.leader().unit() == v1::LENGTH_UNIT_SBU_NORMALISED) {
      Malformed("reply_rotations",
                "LENGTH_UNIT_METRES or LENGTH_UNIT_MILLIMETRES in leader.unit: a unit that differs "
                "between "
                "axes has no rotations",
                "LENGTH_UNIT_SBU_NORMALISED");
    }
    if (request_.reply_joint_names_size() > 0) {
      Malformed("reply_rotations", "no reply_joint_names: a rig needs every joint",
                StrCat(request_.reply_joint_names_size(), " names"));
    }
    // Without frames, the leader has violations of its own.
    if (leader_.frame_count() == 0) return;
    reply_.rig = MakeRigSource(model_.skeleton, leader_, request_.leader().frame_rate_hz());
  }

  int ChunkFrames() {
    if (!request_.has_chunk_frames()) return limits_.default_chunk_frames;
    fields_.Whole("chunk_frames", request_.chunk_frames(), 1, limits_.max_chunk_frames);
    return static_cast<int>(request_.chunk_frames());
  }

  batching::Priority CallPriority() {
    const std::optional<batching::Priority> priority = PriorityOf(request_);
    if (priority.has_value()) return *priority;
    const std::string& name = v1::Priority_Name(request_.priority());
    Malformed("priority", "PRIORITY_INTERACTIVE, PRIORITY_BULK or no value",
              name.empty() ? StrCat(request_.priority()) : name);
    return batching::Priority::kInteractive;
  }

  void Malformed(absl::string_view field, absl::string_view expected, absl::string_view got) {
    fields_.violations().Malformed(field, expected, got);
  }

  const v1::SynthesizeRequest& request_;
  const engine::ModelDescription& model_;
  const RequestLimits& limits_;
  const uint32_t label_frames_;
  RequestFields fields_;

  PositionFormat format_;  // of the leader
  motion::Poses leader_;
  std::optional<motion::Levelling> levelling_;  // absent if the caller's world is level
  ReplyMapping reply_;
};

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
  return ValidateRequest(request, model, limits, "", request.leader().frame_count());
}

absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits, std::string prefix,
                                                 uint32_t label_frames) {
  return Validation(request, model, limits, std::move(prefix), label_frames).Run();
}

}  // namespace duet::server::service
