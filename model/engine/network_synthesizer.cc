#include "model/engine/network_synthesizer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/engine/candidates.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/leader_statistics.h"
#include "model/engine/mixture.h"
#include "model/engine/windows.h"
#include "model/motion/feet.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/resample.h"
#include "model/solver/body_model.h"
#include "model/solver/follower.h"

namespace duet::engine {
namespace {

constexpr int kOverlap = 1;  // windows that are measured share the frame they meet in

// How far a follower may be turned away in a class in which it does not face its leader, degrees.
constexpr float kTurnedRound = 180;

// What one class permits at full weight.
std::vector<solver::ContactRule> RulesOfClasses(const ModelDescription& description,
                                                const body::Body& body) {
  std::vector<solver::ContactRule> rules(description.classes.size());
  solver::ContactRule unknown;
  const auto rule_of = [&](const std::string& name) -> solver::ContactRule& {
    const auto found = std::find(description.classes.begin(), description.classes.end(), name);
    if (found == description.classes.end()) return unknown;
    return rules[static_cast<std::size_t>(found - description.classes.begin())];
  };
  for (const std::string& name : description.touching_classes) rule_of(name).overlap = 1;
  for (const HandContact& contact : description.hand_contacts) {
    rule_of(contact.interaction_class).hands = 1;
    rule_of(contact.interaction_class).hands_metres = static_cast<float>(contact.metres);
  }
  for (const TrunkContact& contact : description.trunk_contacts) {
    solver::ContactRule& rule = rule_of(contact.interaction_class);
    for (std::size_t a = 0; a < std::min(body.arms.size(), rule.holds.size()); ++a) {
      const bool is_hand = body.arms[a].end == description.skeleton.Find(contact.hand);
      if (is_hand) rule.holds[a] = {1, contact.place};
    }
  }
  for (const FacingClass& facing : description.facing_classes) {
    rule_of(facing.interaction_class).away_degrees = static_cast<float>(facing.degrees);
  }
  return rules;
}

motion::Poses StartPose(const ModelDescription& description, const SynthesisWindow& window) {
  if (!window.start || window.start->pose.empty()) return {0, description.skeleton.joint_count()};
  return {description.skeleton.joint_count(), window.start->pose};
}

absl::Status CheckFinite(const motion::Poses& follower) {
  if (std::all_of(follower.all().begin(), follower.all().end(), motion::IsFinite)) {
    return absl::OkStatus();
  }
  return absl::InternalError("the network's result is not finite");
}

// Sets the follower's limb lengths in every frame to those of its start's pose, or else to the
// leader's median lengths times ModelDescription::bone_ratios.
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

// The follower's body: that of its start's pose, or else the leader's in the follower's size.
// Errors: those of BodyModel::Measure.
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

// Moves a follower without a start vertically so that its lowest foot is as high as the leader's.
// Does nothing for a skeleton without feet.
void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower) {
  if (window.start || !skeleton.feet) return;
  const motion::Vec3 lift{
      0, LowestFoot(*skeleton.feet, window.leader) - LowestFoot(*skeleton.feet, *follower), 0};
  for (motion::Vec3& position : follower->all()) position += lift;
}

// The window's first frames as the caller has them: the settled ones and those that were sent, or
// the pose of the start, or none.
motion::Poses GivenFrames(const ModelDescription& description, const SynthesisWindow& window) {
  if (window.settled.empty()) return StartPose(description, window);
  motion::Poses given = window.settled;
  given.Append(window.sent.all());
  return given;
}

// Most inputs of one evaluation, unless there are more windows: candidates must not multiply the
// memory of a batch.
constexpr std::size_t kMostTogether = 32;

class NetworkSynthesizer : public Synthesizer {
 public:
  NetworkSynthesizer(ModelDescription description, motion::StandardOrigin origin,
                     std::unique_ptr<const Network> network, bool as_served,
                     std::optional<Critic> critic)
      : description_(std::move(description)),
        origin_(origin),
        network_(std::move(network)),
        as_served_(as_served),
        body_(body::FindBody(description_.skeleton)),
        solver_(description_.skeleton, description_.frame_rate_hz),
        judge_(description_.skeleton, std::move(critic)) {
    description_.clean_up = as_served;
  }

  const ModelDescription& description() const override { return description_; }

  std::vector<WindowResult> Synthesize(
      absl::Span<const SynthesisWindow* const> windows) const override {
    if (windows.empty()) return {};
    std::vector<Task> tasks;
    std::vector<NetworkInput> inputs;
    for (const SynthesisWindow* window : windows) {
      tasks.push_back(Prepare(*window, &inputs));
    }
    const absl::StatusOr<std::vector<motion::Poses>> followers = RunNetwork(inputs, windows.size());
    if (!followers.ok()) return {windows.size(), followers.status()};
    std::vector<WindowResult> results;
    for (const Task& task : tasks) {
      results.push_back(IsCancelled(inputs[task.first])
                            ? absl::CancelledError("cancelled while it was being answered")
                            : Answer(task, *followers));
    }
    return results;
  }

  std::optional<double> Unfamiliarity(const ClipRequest& request) const override {
    const ModelDescription& model = description_;
    if (!model.leader_statistics) return std::nullopt;
    const int frames = motion::ResampledFrameCount(request.leader.frame_count(),
                                                   request.frame_rate_hz, model.frame_rate_hz);
    const WindowPlan plan = PlanWindows(frames, model.window_frames, kOverlap);
    std::vector<double> windows;
    for (const int start : plan.starts) {
      motion::Poses leader(plan.length, model.skeleton.joint_count());
      for (int t = 0; t < plan.length; ++t) {
        SampleLinear(request.leader, (start + t) * request.frame_rate_hz / model.frame_rate_hz,
                     leader[t]);
      }
      windows.push_back(engine::Unfamiliarity(*model.leader_statistics, model.skeleton, leader,
                                              model.frame_rate_hz));
      // Positions may be as large as a float can be.
      if (!std::isfinite(windows.back())) return std::nullopt;
    }
    // The value that a tenth of the windows exceeds: a long familiar part does not hide an
    // unfamiliar one.
    return NinthDecile(std::move(windows));
  }

 private:
  // A window on its way through the network.
  struct Task {
    const SynthesisWindow* window;
    motion::Standardisation standardisation;
    Mixture mixture;
    int candidates;
    std::size_t first;  // of its inputs: the evaluations of the first candidate, of the second, ...
  };

  Task Prepare(const SynthesisWindow& window, std::vector<NetworkInput>* inputs) const {
    const motion::Standardisation standardisation =
        WindowStandardisation(description_.skeleton, window, origin_);
    NetworkInput input = Standardise(standardisation, window);
    const int count = CandidateCount(description_, window.options.sampling);
    Task task{&window, standardisation, Mixture(description_, body_, input), count, inputs->size()};
    const uint64_t seed = input.sampling.seed;
    for (int n = 0; n < count; ++n) {
      input.sampling.seed = CandidateSeed(seed, n);
      task.mixture.AddInputs(input, inputs);
    }
    return task;
  }

  // Evaluates the inputs of `windows` windows.
  absl::StatusOr<std::vector<motion::Poses>> RunNetwork(const std::vector<NetworkInput>& inputs,
                                                        std::size_t windows) const {
    const std::size_t most = std::max(windows, kMostTogether);
    if (inputs.size() <= most) return RunChecked(inputs);
    std::vector<motion::Poses> followers;
    for (std::size_t first = 0; first < inputs.size(); first += most) {
      absl::StatusOr<std::vector<motion::Poses>> some =
          RunChecked(absl::MakeConstSpan(inputs).subspan(first, most));
      if (!some.ok()) return some;
      std::move(some->begin(), some->end(), std::back_inserter(followers));
    }
    return followers;
  }

  // Going on with an answer of another shape would read past it.
  absl::StatusOr<std::vector<motion::Poses>> RunChecked(
      absl::Span<const NetworkInput> inputs) const {
    absl::StatusOr<std::vector<motion::Poses>> followers = network_->Run(inputs);
    if (!followers.ok()) return followers;
    if (followers->size() != inputs.size()) {
      return absl::InternalError(absl::StrCat("the network answered ", followers->size(),
                                              " windows, expected ", inputs.size()));
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const motion::Poses &leader = inputs[i].leader, &follower = (*followers)[i];
      if (follower.frame_count() == leader.frame_count() &&
          follower.joint_count() == leader.joint_count()) {
        continue;
      }
      return absl::InternalError(absl::StrCat(
          "the network answered ", follower.frame_count(), " frames of ", follower.joint_count(),
          " joints, expected ", leader.frame_count(), " of ", leader.joint_count()));
    }
    return followers;
  }

  // The answer to a window, of the network's answers to all windows.
  WindowResult Answer(const Task& task, absl::Span<const motion::Poses> answers) const {
    std::vector<motion::Poses> candidates;
    for (int n = 0; n < task.candidates; ++n) {
      const std::size_t count = task.mixture.evaluations();
      candidates.push_back(task.mixture.Combine(
          answers.subspan(task.first + static_cast<std::size_t>(n) * count, count)));
    }
    if (candidates.size() > 1) return Choose(task, candidates);
    return Finish(task, candidates[0], task.window->pins);
  }

  // The best of a window's candidates, finished. Fails if one of them is not finite.
  WindowResult Choose(const Task& task, absl::Span<const motion::Poses> candidates) const {
    const SynthesisWindow& window = *task.window;
    std::vector<motion::Poses> followers;
    for (const motion::Poses& candidate : candidates) {
      WindowResult finished = Finish(task, candidate, /*pins=*/{});
      if (!finished.ok()) return finished;
      followers.push_back(*std::move(finished));
    }
    const int given = GivenFrames(description_, window).frame_count();
    const int best = judge_.Best(window.leader, followers, given, description_.frame_rate_hz,
                                 window.pins, RulesOf(task), window.labels);
    // Only the chosen one is moved to the pins: a sample that is near already is the better one.
    if (!window.pins.empty()) {
      return Finish(task, candidates[static_cast<std::size_t>(best)], window.pins);
    }
    return std::move(followers[static_cast<std::size_t>(best)]);
  }

  WindowResult Finish(const Task& task, const motion::Poses& standard,
                      const motion::Pins& pins) const {
    const SynthesisWindow& window = *task.window;
    motion::Poses follower = task.standardisation.Invert(standard);
    if (absl::Status status = CheckFinite(follower); !status.ok()) return status;
    if (as_served_) {
      KeepLimbLengths(description_, window, &follower);
      ShareFloor(description_.skeleton, window, &follower);
    }
    const bool solves = window.options.clean_up.value_or(description_.cleaned_up_by_default()) &&
                        solver_.CanSolve();
    solver::Situation situation{window.leader, window.hidden_frames,
                                GivenFrames(description_, window), RulesOf(task), pins};
    if (solves || !window.settled.empty()) solver_.Join(situation.given, &follower);
    if (!solves) {
      if (!pins.empty()) solver_.MoveToPins(pins, situation.given.frame_count(), &follower);
      return follower;
    }
    absl::StatusOr<solver::BodyModel> person = PersonOf(description_, window);
    if (!person.ok()) return person.status();
    solver_.Solve(situation, *person, &follower);
    return follower;
  }

  solver::ContactRules RulesOf(const Task& task) const {
    return ContactRulesOf(description_, body_, task.mixture.labels());
  }

  ModelDescription description_;
  const motion::StandardOrigin origin_;
  const std::unique_ptr<const Network> network_;
  const bool as_served_;
  const body::Body body_;
  const solver::FollowerSolver solver_;
  const CandidateJudge judge_;
};

constexpr motion::StandardOrigin kOrigin = motion::StandardOrigin::kFirstFrame;

// A network that returns the same followers to every call.
class GivenFollowers : public Network {
 public:
  explicit GivenFollowers(std::vector<motion::Poses> followers)
      : followers_(std::move(followers)) {}
  absl::StatusOr<std::vector<motion::Poses>> Run(absl::Span<const NetworkInput>) const override {
    return followers_;
  }

 private:
  const std::vector<motion::Poses> followers_;
};

}  // namespace

std::unique_ptr<Synthesizer> MakeSynthesizer(ModelDescription description,
                                             motion::StandardOrigin origin,
                                             std::unique_ptr<const Network> network, bool as_served,
                                             std::optional<Critic> critic) {
  return std::make_unique<NetworkSynthesizer>(std::move(description), origin, std::move(network),
                                              as_served, std::move(critic));
}

std::vector<WindowResult> FinishMotions(const ModelDescription& description,
                                        const std::vector<SynthesisWindow>& windows,
                                        const std::vector<motion::Poses>& followers) {
  std::vector<motion::Poses> standard;
  std::vector<SynthesisWindow> copies = windows;
  std::vector<const SynthesisWindow*> pointers;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    standard.push_back(
        WindowStandardisation(description.skeleton, windows[i], kOrigin).Apply(followers[i]));
    copies[i].options.sampling.candidates = 1;
    pointers.push_back(&copies[i]);
  }
  return MakeSynthesizer(description, kOrigin,
                         std::make_unique<GivenFollowers>(std::move(standard)))
      ->Synthesize(pointers);
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
