#include "model/engine/network_synthesizer.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/body/limbs.h"
#include "model/cleanup/live_bounds.h"
#include "model/cleanup/steps_in_time.h"
#include "model/engine/asked_turns.h"
#include "model/engine/candidates.h"
#include "model/engine/finishing.h"
#include "model/engine/standard_window.h"
#include "model/engine/unfamiliarity.h"
#include "model/engine/window_standardisation.h"
#include "model/solver/girdles.h"
#include "model/solver/stature.h"

namespace duet::engine {
namespace {

using Windows = absl::Span<const SynthesisWindow* const>;

// Most inputs of one evaluation, unless there are more windows: candidates must not multiply the
// memory of a batch.
constexpr std::size_t kMostTogether = 32;

// The leader without the frames that are a guess: one who lands goes on through the floor.
motion::Poses KnownLeader(const SynthesisWindow& window) {
  motion::Poses known = window.leader;
  known.Resize(known.frame_count() - window.hidden_frames);
  return known;
}

class NetworkSynthesizer : public Synthesizer {
 public:
  NetworkSynthesizer(ModelDescription description, motion::StandardOrigin origin,
                     std::unique_ptr<const Network> network, const PipelineOptions& options,
                     std::optional<Critic> critic)
      : description_(std::move(description)),
        origin_(origin),
        network_(std::move(network)),
        options_(options),
        live_bounds_(description_.skeleton),
        body_(body::FindBody(description_.skeleton)),
        girdles_(description_.skeleton),
        clean_up_(description_.skeleton, CleaningOf(description_, options.cleaning)),
        judge_(description_.skeleton, std::move(critic)) {
    description_.clean_up = options.clean_up;
  }

  const ModelDescription& description() const override { return description_; }

  std::vector<WindowResult> Synthesize(Windows windows) const override {
    if (windows.empty()) return {};
    std::vector<motion::Standardisation> standardisations;
    std::vector<NetworkInput> inputs;
    for (const SynthesisWindow* window : windows) {
      standardisations.push_back(WindowStandardisation(description_.skeleton, *window, origin_));
      AddCandidates(Standardise(standardisations.back(), *window), Candidates(*window), &inputs);
    }
    const absl::StatusOr<std::vector<motion::Poses>> followers = RunNetwork(inputs, windows.size());
    if (!followers.ok()) return {windows.size(), followers.status()};
    std::vector<WindowResult> results;
    std::size_t first = 0;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      const std::size_t count = static_cast<std::size_t>(Candidates(*windows[i]));
      results.push_back(IsCancelled(inputs[first])
                            ? absl::CancelledError("cancelled while it was being answered")
                            : Answer(*windows[i], standardisations[i], inputs[first],
                                     absl::MakeConstSpan(*followers).subspan(first, count)));
      first += count;
    }
    return results;
  }

  std::optional<double> Unfamiliarity(const ClipRequest& request) const override {
    return engine::Unfamiliarity(description_, request);
  }

 private:
  int Candidates(const SynthesisWindow& window) const {
    return CandidateCount(description_, window.options.sampling);
  }

  static void AddCandidates(NetworkInput input, int count, std::vector<NetworkInput>* inputs) {
    const uint64_t seed = input.sampling.seed;
    input.sampling.variety = CandidateVariety(input.sampling.variety, count);
    for (int n = 0; n < count; ++n) {
      input.sampling.seed = CandidateSeed(seed, n);
      inputs->push_back(n + 1 < count ? input : std::move(input));
    }
  }

  // Evaluates the candidates of `windows` windows.
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

  // The answer to a window, of the network's candidates. `input`: of the first one.
  WindowResult Answer(const SynthesisWindow& window, const motion::Standardisation& standardisation,
                      const NetworkInput& input, absl::Span<const motion::Poses> candidates) const {
    // Only candidates that are compared with each other need all stages at once.
    const bool is_finished = candidates.size() > 1;
    WindowResult first = is_finished ? Choose(window, standardisation, candidates)
                                     : FinishTrunk(window, standardisation, candidates[0]);
    if (!first.ok()) return first;
    std::vector<motion::Poses> followers = {*std::move(first)};
    const absl::StatusOr<std::size_t> best =
        TurnAsAsked(window, standardisation, input, &followers);
    if (!best.ok()) return best.status();
    if (is_finished && *best == 0) return std::move(followers[0]);
    return FinishBody(window, window.pins, std::move(followers[*best]));
  }

  // Adds samples to the first one until one turns as the labels ask. Returns the index of the one
  // that does so best. Windows of an endless motion keep their noise.
  absl::StatusOr<std::size_t> TurnAsAsked(const SynthesisWindow& window,
                                          const motion::Standardisation& standardisation,
                                          const NetworkInput& input,
                                          std::vector<motion::Poses>* followers) const {
    if (!description_.samples || window.options.sampling.first_frame) return 0;
    const AskedTurns turns(description_, window);
    if (turns.demand() == 0) return 0;
    std::vector<std::vector<double>> samples = {turns.TurnsOf(window.leader, (*followers)[0])};
    if (IsDecided(turns, samples)) return 0;
    for (const std::vector<NetworkInput>& inputs : DrawnAgain(description_, turns, window, input)) {
      const absl::StatusOr<std::vector<motion::Poses>> answers = RunNetwork(inputs, 1);
      if (!answers.ok()) return answers.status();
      for (const motion::Poses& answer : *answers) {
        // Turns are measured once the trunk is finished, because the network's own hips can be
        // turned over or shrunk to a point.
        WindowResult follower = FinishTrunk(window, standardisation, answer);
        if (!follower.ok()) return follower.status();
        samples.push_back(turns.TurnsOf(window.leader, *follower));
        followers->push_back(*std::move(follower));
      }
      if (IsDecided(turns, samples)) break;
    }
    return MostAsAsked(turns, samples);
  }

  // The best of a window's candidates, finished. Fails if one of them is not finite.
  WindowResult Choose(const SynthesisWindow& window, const motion::Standardisation& standardisation,
                      absl::Span<const motion::Poses> candidates) const {
    std::vector<motion::Poses> followers;
    for (const motion::Poses& candidate : candidates) {
      WindowResult finished = Finish(window, standardisation, candidate, /*pins=*/{});
      if (!finished.ok()) return finished;
      followers.push_back(*std::move(finished));
    }
    const int best = judge_.Best(window.leader, followers, SettledFrames(window),
                                 description_.frame_rate_hz, window.options.sampling.variety,
                                 window.pins, MeetingsOf(description_, window), window.labels);
    // Only the chosen one is moved to the pins: a sample that is near already is the better one.
    if (!window.pins.empty()) {
      return Finish(window, standardisation, candidates[static_cast<std::size_t>(best)],
                    window.pins);
    }
    return std::move(followers[static_cast<std::size_t>(best)]);
  }

  WindowResult Finish(const SynthesisWindow& window, const motion::Standardisation& standardisation,
                      const motion::Poses& standard, const motion::Pins& pins) const {
    WindowResult trunk = FinishTrunk(window, standardisation, standard);
    if (!trunk.ok()) return trunk;
    return FinishBody(window, pins, *std::move(trunk));
  }

  // The first stages of Finish. The others hardly turn the follower.
  WindowResult FinishTrunk(const SynthesisWindow& window,
                           const motion::Standardisation& standardisation,
                           const motion::Poses& standard) const {
    motion::Poses follower = standardisation.Invert(standard);
    if (absl::Status status = CheckFinite(follower); !status.ok()) return status;
    if (options_.keep_limb_lengths) KeepLimbLengths(description_, window, &follower);
    if (IsCleanedUp(window)) KeepGirdles(window, SettledFrames(window), false, &follower);
    if (options_.share_floor) ShareFloor(description_.skeleton, window, &follower);
    if (IsCleanedUp(window)) {
      clean_up_.CorrectTrunk(window.leader, {description_.frame_rate_hz, SettledFrames(window)},
                             &follower);
    }
    return follower;
  }

  // Makes pelvis and shoulders rigid, from frame `first` on.
  void KeepGirdles(const SynthesisWindow& window, int first, bool feet_stay,
                   motion::Poses* follower) const {
    const solver::GirdleWidths widths = GirdleWidthsOf(description_, girdles_, window);
    for (int t = first; t < follower->frame_count(); ++t) {
      if (feet_stay) {
        girdles_.ApplyAboveFeet(widths, (*follower)[t]);
      } else {
        girdles_.Apply(widths, (*follower)[t]);
      }
    }
  }

  // The other stages of Finish.
  motion::Poses FinishBody(const SynthesisWindow& window, const motion::Pins& pins,
                           motion::Poses follower) const {
    const bool cleans = IsCleanedUp(window);
    const solver::Stretches stretches = solver::MeasureStretches(body_.legs, follower);
    const cleanup::Meetings meetings = MeetingsOf(description_, window);
    const cleanup::Timing timing = FeetTiming(description_, window);
    const bool bounded = cleans && window.options.sampling.first_frame.has_value();
    const auto face_leader = [&] {
      clean_up_.FaceLeader(window.leader, MostAwayOf(description_, window), timing, &follower);
    };
    if (cleans) {
      // A live body goes on from what was sent, which is joined below.
      if (!bounded) face_leader();
      clean_up_.CorrectBody(window.leader, TouchOf(description_, window), meetings,
                            {description_.frame_rate_hz, SettledFrames(window)}, &follower);
    }
    JoinSent(description_, window, &follower);
    if (bounded) {
      face_leader();
      live_bounds_.BoundBody(window.leader, timing, &follower);
    }
    std::optional<cleanup::PinnedMotion> pinned;
    if (!pins.empty()) {
      pinned.emplace(clean_up_.ApproachPins(window.leader, TouchOf(description_, window), pins,
                                            timing, &follower));
    }
    if (cleans) {
      clean_up_.PlaceFeet(window.leader, timing, &follower);
      solver::StatureOptions stature{description_.frame_rate_hz, timing.settled};
      if (description_.hip_height > 0) stature.least_height = description_.hip_height;
      KeepStature(body_.legs, stretches, stature, &follower);
      clean_up_.PlaceHands(window.leader, meetings, timing, &follower);
    }
    if (IsInTime(window)) {
      // After the feet are placed, because a foot that stands does so at every time.
      cleanup::StepInTime(*description_.skeleton.feet, window.leader, timing, &follower);
      if (options_.keep_limb_lengths) KeepLimbLengths(description_, window, &follower);
    }
    if (bounded) live_bounds_.BoundFeet(KnownLeader(window), timing, &follower);
    if (cleans) KeepGirdles(window, timing.settled, true, &follower);
    if (pinned) clean_up_.PlacePins(*pinned, window.leader, timing, &follower);
    HoldSettledPins(window, pins, &follower);
    return follower;
  }

  // Moves the network's version of the settled frames to their pins, and eases what follows: it is
  // blended with the frames that the window before it moved there.
  void HoldSettledPins(const SynthesisWindow& window, const motion::Pins& pins,
                       motion::Poses* follower) const {
    motion::Pins settled;
    for (const motion::Pin& pin : pins) {
      if (pin.frame <= window.settled.frame_count() - 1) settled.push_back(pin);
    }
    if (settled.empty()) return;
    const cleanup::Timing timing{description_.frame_rate_hz, 0};
    const cleanup::PinnedMotion pinned = clean_up_.ApproachPins(
        window.leader, TouchOf(description_, window), settled, timing, follower);
    clean_up_.PlacePins(pinned, window.leader, timing, follower);
  }

  // A window of an endless motion does not know the steps that come.
  bool IsInTime(const SynthesisWindow& window) const {
    return description_.steps_in_time && description_.skeleton.feet && IsCleanedUp(window) &&
           !window.options.sampling.first_frame;
  }

  bool IsCleanedUp(const SynthesisWindow& window) const {
    return window.options.clean_up.value_or(description_.cleaned_up_by_default());
  }

  ModelDescription description_;
  const motion::StandardOrigin origin_;
  const std::unique_ptr<const Network> network_;
  const PipelineOptions options_;
  const cleanup::LiveBounds live_bounds_;
  const body::Body body_;
  const solver::Girdles girdles_;
  const cleanup::CleanUp clean_up_;
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
