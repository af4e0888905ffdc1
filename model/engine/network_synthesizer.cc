#include "model/engine/network_synthesizer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/engine/candidates.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/finishing.h"
#include "model/engine/leader_statistics.h"
#include "model/engine/mixture.h"
#include "model/engine/standard_window.h"
#include "model/engine/windows.h"
#include "model/motion/resample.h"
#include "model/solver/follower.h"

namespace duet::engine {
namespace {

// Windows that are measured need share no more than the frame they meet in.
constexpr int kOverlap = 1;

motion::Poses LeaderWindow(const ModelDescription& model, const ClipRequest& request, int start,
                           int length) {
  motion::Poses window(length, model.skeleton.joint_count());
  for (int t = 0; t < length; ++t) {
    SampleLinear(request.leader, (start + t) * request.frame_rate_hz / model.frame_rate_hz,
                 window[t]);
  }
  return window;
}

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
    const ModelDescription& model = description_;
    if (!model.leader_statistics) return std::nullopt;
    const int frames = motion::ResampledFrameCount(request.leader.frame_count(),
                                                   request.frame_rate_hz, model.frame_rate_hz);
    const WindowPlan plan = PlanWindows(frames, model.window_frames, kOverlap);
    std::vector<double> windows;
    for (const int start : plan.starts) {
      windows.push_back(engine::Unfamiliarity(*model.leader_statistics, model.skeleton,
                                              LeaderWindow(model, request, start, plan.length),
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
    return ContactRulesOf(description_, body_, task.mixture.labels());
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
                                             std::unique_ptr<const Network> network,
                                             const PipelineOptions& options,
                                             std::optional<Critic> critic) {
  return std::make_unique<NetworkSynthesizer>(std::move(description), origin, std::move(network),
                                              options, std::move(critic));
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

}  // namespace duet::engine
