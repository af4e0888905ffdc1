#include "model/engine/asked_turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>

#include "model/base/median.h"
#include "model/engine/candidates.h"
#include "model/engine/finishing.h"

namespace duet::engine {
namespace {

constexpr double kLeastDemand = 0.1;  // a label that only touches the end of a window
// Degrees of a turn that is asked for.
constexpr double kTurn = 360;
// Captured followers turn once for a label of up to three seconds, whether it is short or long.
// Longer labels have a turn in every so many times that a whole turn takes at the captured speed.
constexpr double kTurnsPerLabel = 1.5;
// A window whose judged frames end within this fraction of a turn does not ask for it: the samples
// find its direction no more often than chance.
constexpr double kLeastSeen = 1.0 / 3;
// Degrees of turning that no label avoids, also back during a turn.
constexpr double kFreeDegrees = 120;
constexpr double kLeastTurn = 230;  // degrees
constexpr std::size_t kFewestStretches = 3;
// Degrees that followers may turn in other classes. 98 % of captured followers turn less within the
// frames of a window.
constexpr double kMostInOthers = 180;
// How further samples differ from the first one: by what the labels that ask for turns, those that
// avoid them, and the noise are multiplied. Each pair differs more than the last.
struct Draw {
  float asked, avoided, noise;
};
constexpr Draw kDraws[] = {{2, 4, 1}, {4, 8, 1.4f}, {8, 16, 2}};
// The variety up to which further samples get more noise: the largest that the server accepts.
constexpr float kMostVariety = 2;
constexpr int kDrawnTogether = 2;
constexpr double kMostDraws = kDrawnTogether * std::size(kDraws);
// The last pair turns most often, but not as the lead shows. It is drawn only if every sample
// before misses at least this fraction of what the labels demand.
constexpr double kHardlyTurns = 0.5;
// Fraction of these samples that a window draws on average, measured on held-out takes
// (docs/results/README.md, "The dance").
constexpr double kDrawnForTurns = 0.6, kDrawnForOthers = 0.03;
// Samples agree on the direction of a turn if the difference between both directions is at least
// this fraction of all their turning.
constexpr double kAgreement = 0.6;
constexpr std::size_t kFewestVotes = 3;
// Weight of turning in the direction that the samples did not agree on.
constexpr double kAgainstTheOthers = 0.7;
// What a mean difference of a whole turn from the other samples costs.
constexpr double kUntypical = 0.5;

// The places of the turning classes in the label vector.
std::vector<std::size_t> TurningIndices(const ModelDescription& description) {
  const auto& classes = description.classes;
  std::vector<std::size_t> indices;
  for (const TurningClass& turning : description.turning_classes) {
    indices.push_back(static_cast<std::size_t>(
        std::find(classes.begin(), classes.end(), turning.interaction_class) - classes.begin()));
  }
  return indices;
}

// How many frames with a label have one turn, as far as the label is long enough for several.
double FramesPerTurn(const ModelDescription& description) {
  std::vector<double> speeds;
  for (const TurningClass& turning : description.turning_classes) {
    speeds.push_back(turning.degrees_per_second);
  }
  return kTurnsPerLabel * kTurn / base::Median(speeds) * description.frame_rate_hz;
}

// What the labels of one frame request.
struct FrameLabels {
  double asked = 0, avoided = 0;  // sum of the absolute weights of turns
  double other = 0;               // largest weight of another class, if no turn has a weight
};

// `turning`: TurningIndices.
FrameLabels ReadLabels(const ModelDescription& description, const std::vector<std::size_t>& turning,
                       const float* weights) {
  FrameLabels labels;
  for (std::size_t k = 0; k < turning.size(); ++k) {
    const double weight = std::clamp(double{weights[turning[k]]}, -1.0, 1.0);
    (weight > 0 ? labels.asked : labels.avoided) += std::abs(weight);
  }
  const double most = *std::max_element(weights, weights + description.classes.size());
  if (labels.asked + labels.avoided == 0) labels.other = std::clamp(most, 0.0, 1.0);
  return labels;
}

// For each turn that is asked for: the sum of the samples' turns, whose sign is the direction in
// which they turn farther, and the sum of the absolute values.
struct Votes {
  std::vector<double> ways, all;
};

Votes VotesOf(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  Votes votes;
  for (const std::vector<double>& sample : samples) {
    const std::vector<double> asked = turns.Asked(sample);
    votes.ways.resize(asked.size());
    votes.all.resize(asked.size());
    for (std::size_t i = 0; i < asked.size(); ++i) {
      votes.ways[i] += asked[i];
      votes.all[i] += std::abs(asked[i]);
    }
  }
  return votes;
}

bool DoAgree(const Votes& votes) {
  for (std::size_t i = 0; i < votes.ways.size(); ++i) {
    if (std::abs(votes.ways[i]) < kAgreement * votes.all[i]) return false;
  }
  return true;
}

// The largest rotation in the frames that are set. Shapes: both alike.
double Farthest(const std::vector<double>& turns, const std::vector<bool>& frames) {
  TurnedRange range;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (frames[i]) range.Add(turns[i] - (i == 0 ? 0 : turns[i - 1]));
  }
  return range.farthest();
}

// How far the turns of two samples differ, in whole turns. Shapes: both alike.
double Apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / kTurn / std::max(1.0, static_cast<double>(a.size()));
}

}  // namespace

bool AsksForTurn(const ModelDescription& description, const float* weights) {
  const std::vector<std::size_t> turning = TurningIndices(description);
  return std::any_of(turning.begin(), turning.end(),
                     [weights](std::size_t c) { return weights[c] > 0; });
}

AskedTurns::AskedTurns(const ModelDescription& description, const SynthesisWindow& window) {
  if (description.turning_classes.empty() || !description.skeleton.hips) return;
  root_ = description.skeleton.root;
  hips_ = *description.skeleton.hips;
  const int frames = window.leader.frame_count();
  const JudgedFrames judged = {std::max(1, SettledFrames(window)),
                               frames - description.lookahead_frames};
  if (judged.end <= judged.begin) return;
  const std::vector<std::size_t> turning = TurningIndices(description);
  const std::size_t classes = description.classes.size();
  std::vector<double> weights;
  for (int t = 0; t < frames; ++t) {
    const FrameLabels labels = ReadLabels(
        description, turning, window.labels.data() + static_cast<std::size_t>(t) * classes);
    weights.push_back(labels.asked);
    if (t == 0 || t >= judged.end) continue;
    const bool is_judged = t >= judged.begin;
    avoided_.push_back(is_judged && labels.avoided > labels.asked);
    other_.push_back(labels.other > 0);
    if (!is_judged) continue;
    share_asked_ += labels.asked;
    share_avoided_ += labels.avoided;
    share_other_ += labels.other;
  }
  for (double* share : {&share_asked_, &share_avoided_, &share_other_}) {
    *share /= judged.end - judged.begin;
  }
  demand_ = share_asked_ + share_avoided_ > 0 ? share_asked_ + share_avoided_ : share_other_;
  if (demand_ < kLeastDemand) demand_ = 0;
  frames_per_turn_ = FramesPerTurn(description);
  const auto asks = [&](int frame) { return weights[static_cast<std::size_t>(frame)] > 0; };
  for (int begin = 0, end = 0; begin < frames; begin = end) {
    for (end = begin + 1; end < frames && asks(end) == asks(begin);) ++end;
    if (asks(begin)) AddAsked(window, begin, end, weights, judged);
  }
}

void AskedTurns::AddAsked(const SynthesisWindow& window, int begin, int end,
                          const std::vector<double>& weights, JudgedFrames judged) {
  const TurnsAround& around = window.turns_around;
  if (begin == 0) begin = 1 - static_cast<int>(around.before.size());
  if (end == window.leader.frame_count()) end += around.after;
  const int frames = end - begin;
  const int count = std::max(1, static_cast<int>(std::lround(frames / frames_per_turn_)));
  for (int k = 0; k < count; ++k) {
    const int first = begin + frames * k / count, last = begin + frames * (k + 1) / count;
    AskedTurn turn;
    turn.begin = std::max(first, judged.begin);
    turn.end = std::min(last, judged.end);
    if (turn.begin >= turn.end) continue;
    const double weight =
        std::accumulate(weights.begin() + turn.begin, weights.begin() + turn.end, 0.0);
    const double seen = static_cast<double>(turn.end - first) / (last - first);
    turn.share = weight / (judged.end - judged.begin);
    if (seen >= kLeastSeen) turn.degrees = kTurn * seen * weight / (turn.end - turn.begin);
    for (int t = first; t < turn.begin; ++t) {
      if (t <= 0) {
        turn.before.Add(around.before[static_cast<std::size_t>(t - begin)]);
      } else if (t < window.settled.frame_count()) {
        turn.before.Add(TurnedAt(hips_, root_, window.settled, window.leader, t));
      }
    }
    asked_.push_back(turn);
  }
}

TurnedRange AskedTurns::RangeOf(const AskedTurn& turn, const std::vector<double>& turns) const {
  TurnedRange range = turn.before;
  for (int t = turn.begin; t < turn.end; ++t) {
    const std::size_t i = static_cast<std::size_t>(t - 1);
    range.Add(turns[i] - (i == 0 ? 0 : turns[i - 1]));
  }
  return range;
}

bool AskedTurns::asks() const {
  return std::any_of(asked_.begin(), asked_.end(),
                     [](const AskedTurn& turn) { return turn.before.farthest() < turn.degrees; });
}

std::vector<double> AskedTurns::TurnsOf(const motion::Poses& leader,
                                        const motion::Poses& follower) const {
  std::vector<double> turns;
  double sum = 0;
  for (std::size_t i = 0; i < other_.size(); ++i) {
    sum += TurnedAt(hips_, root_, follower, leader, static_cast<int>(i) + 1);
    turns.push_back(sum);
  }
  return turns;
}

std::vector<double> AskedTurns::Asked(const std::vector<double>& turns) const {
  std::vector<double> asked;
  for (const AskedTurn& turn : asked_) {
    const TurnedRange range = RangeOf(turn, turns);
    asked.push_back(range.forwards() > range.backwards() ? range.forwards() : -range.backwards());
  }
  return asked;
}

double AskedTurns::MissOf(const AskedTurn& turn, const std::vector<double>& turns,
                          double way) const {
  const TurnedRange range = RangeOf(turn, turns);
  const double most = range.farthest();
  const double right = way == 0 ? most : way > 0 ? range.forwards() : range.backwards();
  const double counts = right + kAgainstTheOthers * (most - right);
  // One turn goes one way.
  const double back = std::min(range.forwards(), range.backwards());
  const double missing = turn.degrees == 0 ? 0 : std::max(0.0, 1 - counts / turn.degrees);
  return turn.share * (missing + std::max(0.0, back - kFreeDegrees) / kLeastTurn);
}

double AskedTurns::Miss(const std::vector<double>& turns, const std::vector<double>& ways) const {
  if (demand_ == 0) return 0;
  double miss = 0;
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    miss += MissOf(asked_[i], turns, ways.empty() ? 0 : ways[i]);
  }
  miss += share_avoided_ * std::max(0.0, Farthest(turns, avoided_) - kFreeDegrees) / kLeastTurn;
  return miss + std::max(0.0, Farthest(turns, other_) / kMostInOthers - 1);
}

int AskedTurns::further_samples() const {
  return static_cast<int>(std::ceil(kMostDraws * std::min(1.0, demand_)));
}

double AskedTurns::share_drawn() const {
  return share_asked_ + share_avoided_ > 0 ? kDrawnForTurns : kDrawnForOthers;
}

std::vector<std::vector<NetworkInput>> DrawnAgain(const ModelDescription& description,
                                                  const AskedTurns& turns,
                                                  const SynthesisWindow& window,
                                                  const NetworkInput& input) {
  std::vector<std::vector<NetworkInput>> groups;
  for (int n = 1; n <= turns.further_samples(); ++n) {
    if ((n - 1) % kDrawnTogether == 0) groups.emplace_back();
    NetworkInput& again = groups.back().emplace_back(input);
    const Sampling& sampling = window.options.sampling;
    again.sampling.seed = CandidateSeed(sampling.seed, sampling.candidates + n - 1);
    const Draw& draw = kDraws[groups.size() - 1];
    again.sampling.variety = std::max(again.sampling.variety,
                                      std::min(kMostVariety, again.sampling.variety * draw.noise));
    for (const std::size_t c : TurningIndices(description)) {
      for (std::size_t i = c; i < again.labels.size(); i += description.classes.size()) {
        again.labels[i] *= again.labels[i] > 0 ? draw.asked : draw.avoided;
      }
    }
  }
  return groups;
}

bool IsDecided(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  const Votes votes = VotesOf(turns, samples);
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& sample : samples) {
    least = std::min(least, turns.Miss(sample, votes.ways));
  }
  if (samples.size() > kMostDraws - kDrawnTogether && least < kHardlyTurns * turns.demand()) {
    return true;
  }
  if (turns.asks() && (samples.size() < kFewestVotes || !DoAgree(votes))) return false;
  return least <= turns.tolerated();
}

std::size_t MostAsAsked(const AskedTurns& turns, const std::vector<std::vector<double>>& samples) {
  const std::vector<double> ways = VotesOf(turns, samples).ways;
  std::vector<double> costs;
  for (const std::vector<double>& sample : samples) {
    const double miss = turns.Miss(sample, ways);
    costs.push_back(miss <= turns.tolerated() ? 0 : miss);
  }
  const double least = *std::min_element(costs.begin(), costs.end());
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (costs[i] <= least) best.push_back(i);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double apart = 0, others = 0;
    for (const std::size_t other : best) {
      if (other == i) continue;
      apart += Apart(samples[i], samples[other]);
      ++others;
    }
    if (others > 0) costs[i] += kUntypical * apart / others;
  }
  return static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
}

double ExpectedSamples(const ModelDescription& description, const SynthesisWindow& window) {
  const Sampling& sampling = window.options.sampling;
  const int candidates = CandidateCount(description, sampling);
  if (!description.samples || sampling.first_frame) return candidates;
  const AskedTurns turns(description, window);
  return candidates + turns.share_drawn() * turns.further_samples();
}

void TurningFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                     int end) {
  if (!skeleton_.hips) return;
  double turned = 0;
  for (int t = begin + 1; t < end; ++t) {
    turned += TurnedAt(*skeleton_.hips, skeleton_.root, follower, leader, t);
  }
  if (end - begin < 2) return;
  degrees_.push_back(std::abs(turned));
  per_frame_.push_back(std::abs(turned) / (end - begin));
}

std::optional<double> TurningFit::DegreesPerSecond(double frame_rate_hz) const {
  if (degrees_.size() < kFewestStretches) return std::nullopt;
  if (base::Median(degrees_) < kLeastTurn) return std::nullopt;
  return base::Median(per_frame_) * frame_rate_hz;
}

}  // namespace duet::engine
