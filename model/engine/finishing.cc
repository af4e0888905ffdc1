#include "model/engine/finishing.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "model/motion/feet.h"
#include "model/motion/limb_lengths.h"

namespace duet::engine {
namespace {

// How far a follower may be turned away in a class in which it does not face its leader, degrees.
constexpr float kTurnedRound = 180;

// What one class permits at full weight.
std::vector<solver::ContactRule> RulesOfClasses(const ModelDescription& description,
                                                const body::Body& body) {
  std::vector<solver::ContactRule> rules(description.classes.size());
  const auto rule_of = [&](const std::string& name) -> solver::ContactRule* {
    const auto found = std::find(description.classes.begin(), description.classes.end(), name);
    if (found == description.classes.end()) return nullptr;
    return &rules[static_cast<std::size_t>(found - description.classes.begin())];
  };
  for (const std::string& name : description.touching_classes) {
    if (solver::ContactRule* rule = rule_of(name)) rule->overlap = 1;
  }
  for (const HandContact& contact : description.hand_contacts) {
    solver::ContactRule* rule = rule_of(contact.interaction_class);
    if (rule == nullptr) continue;
    rule->hands = 1;
    rule->hands_metres = static_cast<float>(contact.metres);
  }
  for (const TrunkContact& contact : description.trunk_contacts) {
    solver::ContactRule* rule = rule_of(contact.interaction_class);
    if (rule == nullptr) continue;
    for (std::size_t a = 0; a < std::min(body.arms.size(), rule->holds.size()); ++a) {
      if (body.arms[a].end == description.skeleton.Find(contact.hand)) {
        rule->holds[a] = {1, contact.place};
      }
    }
  }
  for (const FacingClass& facing : description.facing_classes) {
    if (solver::ContactRule* rule = rule_of(facing.interaction_class)) {
      rule->away_degrees = static_cast<float>(facing.degrees);
    }
  }
  return rules;
}

motion::Poses StartPose(const ModelDescription& description, const SynthesisWindow& window) {
  if (!window.start || window.start->pose.empty()) return {0, description.skeleton.joint_count()};
  return {description.skeleton.joint_count(), window.start->pose};
}

}  // namespace

absl::Status CheckFinite(const motion::Poses& follower) {
  if (std::all_of(follower.all().begin(), follower.all().end(), motion::IsFinite)) {
    return absl::OkStatus();
  }
  return absl::InternalError("the network's result is not finite");
}

void KeepLimbLengths(const ModelDescription& description, const SynthesisWindow& window,
                     motion::Poses* follower) {
  const motion::Skeleton& skeleton = description.skeleton;
  const motion::Poses start = StartPose(description, window);
  std::vector<float> lengths = MedianBoneLengths(skeleton, start.empty() ? window.leader : start);
  if (start.empty() && !description.bone_ratios.empty()) {
    for (std::size_t b = 0; b < lengths.size(); ++b) {
      lengths[b] *= static_cast<float>(description.bone_ratios[b]);
    }
  }
  SetBoneLengths(skeleton, lengths, follower);
}

absl::StatusOr<solver::BodyModel> PersonOf(const ModelDescription& description,
                                           const SynthesisWindow& window) {
  const motion::Poses start = StartPose(description, window);
  absl::StatusOr<solver::BodyModel> person =
      solver::BodyModel::Measure(description.skeleton, start.empty() ? window.leader : start);
  if (person.ok() && start.empty() && !description.bone_ratios.empty()) {
    const double sum =
        std::accumulate(description.bone_ratios.begin(), description.bone_ratios.end(), 0.0);
    person->Scale(static_cast<float>(sum / static_cast<double>(description.bone_ratios.size())));
  }
  return person;
}

void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower) {
  if (window.start || !skeleton.feet) return;
  const motion::Vec3 lift{
      0, LowestFoot(*skeleton.feet, window.leader) - LowestFoot(*skeleton.feet, *follower), 0};
  for (motion::Vec3& position : follower->all()) position += lift;
}

motion::Poses GivenFrames(const ModelDescription& description, const SynthesisWindow& window) {
  if (window.settled.empty()) return StartPose(description, window);
  motion::Poses given = window.settled;
  given.Append(window.sent.all());
  return given;
}

solver::ContactRules ContactRulesOf(const ModelDescription& description, const body::Body& body,
                                    absl::Span<const float> labels) {
  const std::vector<solver::ContactRule> classes = RulesOfClasses(description, body);
  float farthest_away = classes.empty() ? kTurnedRound : 0;
  for (const solver::ContactRule& rule : classes) {
    farthest_away = std::max(farthest_away, rule.away_degrees);
  }
  solver::ContactRules rules(classes.empty() ? 0 : labels.size() / classes.size());
  for (std::size_t t = 0; t < rules.size(); ++t) {
    solver::ContactRule& rule = rules[t];
    float weights = 0, away = 0;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const float weight = std::max(0.0f, labels[t * classes.size() + c]);
      rule.overlap += weight * classes[c].overlap;
      rule.hands += weight * classes[c].hands;
      rule.hands_metres += weight * classes[c].hands * classes[c].hands_metres;
      for (std::size_t a = 0; a < rule.holds.size(); ++a) {
        const solver::TrunkHold& hold = classes[c].holds[a];
        rule.holds[a].place += hold.place * (weight * hold.weight);
        rule.holds[a].weight += weight * hold.weight;
      }
      away += weight * classes[c].away_degrees;
      weights += weight;
    }
    if (rule.hands > 0) rule.hands_metres /= rule.hands;
    rule.overlap = std::min(1.0f, rule.overlap);
    rule.hands = std::min(1.0f, rule.hands);
    for (solver::TrunkHold& hold : rule.holds) {
      if (hold.weight > 0) hold.place = hold.place / hold.weight;
      hold.weight = std::min(1.0f, hold.weight);
    }
    // A follower of no class may do what those of any class do.
    rule.away_degrees = weights > 0 ? away / weights : farthest_away;
  }
  return rules;
}

}  // namespace duet::engine
