#include <cstdint>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "server/service/request_fields.h"

namespace duet::server::service {
namespace {

static_assert(RequestLimits().max_candidates == engine::kMostCandidates);

int ValidateCandidates(const v1::SynthesizeRequest& request, const RequestLimits& limits,
                       Violations& violations) {
  if (!request.has_candidates()) return engine::kDefaultCandidates;
  const uint32_t candidates = request.candidates();
  if (candidates >= 1 && candidates <= static_cast<uint32_t>(limits.max_candidates)) {
    return static_cast<int>(candidates);
  }
  violations.Malformed("candidates", absl::StrCat("1 to ", limits.max_candidates),
                       absl::StrCat(candidates));
  return engine::kDefaultCandidates;
}

engine::Sampling ValidateSampling(const v1::SynthesizeRequest& request, const RequestLimits& limits,
                                  Violations& violations) {
  engine::Sampling sampling;
  if (request.has_seed()) sampling.seed = request.seed();
  if (request.has_variety()) sampling.variety = request.variety();
  // Negated, so that NaN is rejected.
  if (!(sampling.variety >= 0 && sampling.variety <= limits.max_variety)) {
    violations.Malformed("variety", absl::StrCat("a finite value in [0, ", limits.max_variety, "]"),
                         base::NumberText(request.variety()));
  }
  if (request.has_reaction()) sampling.reaction = request.reaction();
  if (!(sampling.reaction >= 0 && sampling.reaction <= engine::kMostReaction)) {
    violations.Malformed("reaction",
                         absl::StrCat("a finite value in [0, ", engine::kMostReaction, "]"),
                         base::NumberText(request.reaction()));
  }
  sampling.candidates = ValidateCandidates(request, limits, violations);
  return sampling;
}

std::optional<bool> ValidateCleanUp(const v1::SynthesizeRequest& request, Violations& violations) {
  switch (request.clean_up()) {
    case v1::CLEAN_UP_UNSPECIFIED:
      return std::nullopt;
    case v1::CLEAN_UP_ON:
      return true;
    case v1::CLEAN_UP_OFF:
      return false;
    default:
      violations.Malformed("clean_up", "CLEAN_UP_ON, CLEAN_UP_OFF or no value",
                           absl::StrCat(request.clean_up()));
      return std::nullopt;
  }
}

using motion::Vec3;

std::string Text(const v1::Point& point) {
  return absl::StrCat("(", point.x(), ", ", point.y(), ", ", point.z(), ")");
}

// Validates the constraints of one request. Each method adds the violations of one field.
class ConstraintCheck {
 public:
  ConstraintCheck(const v1::SynthesizeRequest& request, const RequestWorld& world,
                  const engine::ModelDescription& model, const RequestLimits& limits,
                  Violations& violations)
      : request_(request), world_(world), model_(model), limits_(limits), violations_(violations) {}

  motion::Pin Read(int index);

 private:
  std::string Field(int index, const char* name) const {
    return absl::StrCat("constraints[", index, "].", name);
  }
  int Joint(int index, const std::string& name);
  void Frame(int index, uint32_t frame);
  Vec3 Position(int index, const v1::JointConstraint& constraint);
  void Softness(int index, float softness);
  void Repetition(int index);

  const v1::SynthesizeRequest& request_;
  const RequestWorld& world_;
  const engine::ModelDescription& model_;
  const RequestLimits& limits_;
  Violations& violations_;
};

int ConstraintCheck::Joint(int index, const std::string& name) {
  const int joint = model_.skeleton.Find(name);
  if (joint < 0) {
    violations_.Mismatch(Field(index, "joint_name"),
                         absl::StrCat("a joint of model ", model_.name, " (",
                                      absl::StrJoin(model_.skeleton.joint_names, ", "), ")"),
                         base::Quoted(name));
  }
  return joint;
}

void ConstraintCheck::Frame(int index, uint32_t frame) {
  const uint32_t frames = request_.leader().frame_count();
  if (frame < frames) return;
  violations_.Malformed(Field(index, "frame"),
                        absl::StrCat("less than the ", frames, " frames of leader"),
                        absl::StrCat(frame));
}

Vec3 ConstraintCheck::Position(int index, const v1::JointConstraint& constraint) {
  const std::string field = Field(index, "position");
  if (!constraint.has_position()) {
    violations_.Malformed(field, "a point", "none");
    return {};
  }
  const v1::Point& point = constraint.position();
  const Vec3 given = {point.x(), point.y(), point.z()};
  if (!IsFinite(given)) {
    violations_.Malformed(field, "finite numbers", Text(point));
    return {};
  }
  if (!world_.coordinates) return {};
  const Vec3 captured = ToWorld(*world_.coordinates, given);
  const Vec3 position = world_.levelling ? world_.levelling->Apply(captured) : captured;
  const uint32_t frame = constraint.frame();
  if (frame >= static_cast<uint32_t>(world_.leader.frame_count())) return position;
  const Vec3 root = world_.leader.at(static_cast<int>(frame), model_.skeleton.root);
  // Negated, so that a conversion that overflowed is rejected too.
  if (!(Distance(position, root) <= limits_.max_constraint_metres)) {
    violations_.Malformed(field,
                          absl::StrCat("at most ", limits_.max_constraint_metres,
                                       " m from the leader in this frame, in leader.unit"),
                          absl::StrCat(Text(point), "; check the unit"));
  }
  return position;
}

void ConstraintCheck::Softness(int index, float softness) {
  // Negated, so that NaN is rejected.
  if (softness >= 0 && softness <= 1) return;
  violations_.Malformed(Field(index, "softness"), "a value in [0, 1]", base::NumberText(softness));
}

// Takes quadratic time; the number of constraints is limited.
void ConstraintCheck::Repetition(int index) {
  const v1::JointConstraint& constraint = request_.constraints(index);
  for (int i = 0; i < index; ++i) {
    const v1::JointConstraint& earlier = request_.constraints(i);
    if (earlier.frame() != constraint.frame() || earlier.joint_name() != constraint.joint_name()) {
      continue;
    }
    violations_.Malformed(absl::StrCat("constraints[", index, "]"),
                          "each joint at most once in a frame",
                          absl::StrCat(base::Quoted(constraint.joint_name()), " in frame ",
                                       constraint.frame(), " again after constraints[", i, "]"));
    return;
  }
}

motion::Pin ConstraintCheck::Read(int index) {
  const v1::JointConstraint& constraint = request_.constraints(index);
  Repetition(index);
  Frame(index, constraint.frame());
  Softness(index, constraint.softness());
  return {Joint(index, constraint.joint_name()), static_cast<double>(constraint.frame()),
          Position(index, constraint), constraint.softness()};
}

}  // namespace

engine::SynthesisOptions ValidateOptions(const v1::SynthesizeRequest& request,
                                         const RequestLimits& limits, Violations& violations) {
  engine::SynthesisOptions options;
  options.sampling = ValidateSampling(request, limits, violations);
  options.clean_up = ValidateCleanUp(request, violations);
  return options;
}

motion::Pins ValidateConstraints(const v1::SynthesizeRequest& request, const RequestWorld& world,
                                 const engine::ModelDescription& model, const RequestLimits& limits,
                                 Violations& violations) {
  const int count = request.constraints_size();
  if (count > limits.max_constraints) {
    violations.Malformed("constraints", absl::StrCat("at most ", limits.max_constraints),
                         absl::StrCat(count));
    return {};
  }
  ConstraintCheck check(request, world, model, limits, violations);
  motion::Pins pins;
  for (int i = 0; i < count; ++i) pins.push_back(check.Read(i));
  return pins;
}

}  // namespace duet::server::service
