#include "model/engine/network_synthesizer.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/engine/candidates.h"
#include "model/engine/finishing.h"
#include "model/engine/mixture.h"
#include "model/engine/standard_window.h"
#include "model/engine/unfamiliarity.h"
#include "model/engine/window_standardisation.h"
#include "model/solver/follower.h"

namespace duet::engine {
namespace {

using Windows = absl::Span<const SynthesisWindow* const>;

// Most inputs of one evaluation, unless there are more windows: candidates must not multiply the
// memory of a batch.
constexpr std::size_t kMostTogether = 32;

class NetworkSynthesizer : public Synthesizer {
 public:
  NetworkSynthesizer(ModelDescription description, motion::StandardOrigin origin,
                     std::unique_ptr<const Network> network, const PipelineOptions& options,
                     std::optional<Critic> critic)
      : description_(std::move(description)),
        origin_(origin),
        network_(std::move(network)),
        options_(options),
        body_(body::FindBody(description_.skeleton)),
        solver_(description_.skeleton, description_.frame_rate_hz),
        judge_(description_.skeleton, std::move(critic)) {
    description_.clean_up = options.clean_up;
  }

  const ModelDescription& description() const override { return description_; }

  std::vector<WindowResult> Synthesize(Windows windows) const override {
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
    return engine::Unfamiliarity(description_, request);
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
    input.sampling.variety = CandidateVariety(input.sampling.variety, count);
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
    const int best =
        judge_.Best(window.leader, followers, given, description_.frame_rate_hz,
                    window.options.sampling.variety, window.pins, RulesOf(task), window.labels);
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
    if (options_.keep_limb_lengths) KeepLimbLengths(description_, window, &follower);
    if (options_.share_floor) ShareFloor(description_.skeleton, window, &follower);
    const bool solves = IsCleanedUp(window) && solver_.CanSolve();
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
    return ContactRulesOf(description_, task.mixture.labels());
  }

  bool IsCleanedUp(const SynthesisWindow& window) const {
    return window.options.clean_up.value_or(description_.cleaned_up_by_default());
  }

  ModelDescription description_;
  const motion::StandardOrigin origin_;
  const std::unique_ptr<const Network> network_;
  const PipelineOptions options_;
  const body::Body body_;
  const solver::FollowerSolver solver_;
  const CandidateJudge judge_;
};

}  // namespace

std::unique_ptr<Synthesizer> MakeSynthesizer(ModelDescription description,
                                             motion::StandardOrigin origin,
                                             std::unique_ptr<const Network> network,
                                             const PipelineOptions& options,
                                             std::optional<Critic> critic) {
  return std::make_unique<NetworkSynthesizer>(std::move(description), origin, std::move(network),
                                              options, std::move(critic));
}

}  // namespace duet::engine
