#include "model/engine/mixture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "model/solver/geometry.h"

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;
using Labels = std::vector<float>;

// The change from contact to the other answer takes about four times as long, seconds. Faster, the
// body jerks; slower, the two answers average where they differ most.
constexpr double kChangeSeconds = 0.08;
// A leader who reaches less far than the first, metres, gives no moment to cross over at, and the
// answers are averaged; one who reaches further than the second does.
constexpr float kNoReach = 0.15f, kFullReach = 0.35f;
// The strength of a class in its time. A class that is seen for a part of the time is recognised
// better if it is somewhat exaggerated: with 1, a half-and-half mix keeps .31 instead of .38 of the
// geometry of its weaker class (duet-eval mixes, s05 left out).
constexpr float kFullStrength = 1.25f;
// The largest part of an avoided class that is subtracted, relative to what the request changes. A
// larger one changes the request itself.
constexpr double kMostAvoided = 0.5;

bool Any(const Labels& labels) {
  return std::any_of(labels.begin(), labels.end(), [](float weight) { return weight > 0; });
}

// How far the leader's hands and feet are from its root towards the partner, the furthest of them.
std::vector<float> Reaches(const body::Body& body, int root, const Poses& leader) {
  std::vector<float> reaches(static_cast<std::size_t>(leader.frame_count()), 0.0f);
  for (int t = 0; t < leader.frame_count(); ++t) {
    float& reach = reaches[static_cast<std::size_t>(t)];
    for (const std::vector<body::Limb>* limbs : {&body.arms, &body.legs}) {
      for (const body::Limb& limb : *limbs) {
        reach = std::max(reach, leader.at(t, root).z - leader.at(t, limb.end).z);
      }
    }
  }
  return reaches;
}

// How far the leader's action has got in each frame, 0 to 1: it is half done when a hand or a foot
// has reached furthest. `clear` becomes how clearly there is such a moment, 0 to 1.
std::vector<float> PhaseOf(const body::Body& body, int root, const Poses& leader,
                           double frame_rate_hz, float* clear) {
  std::vector<float> phase = Reaches(body, root, leader);
  const auto [least, most] = std::minmax_element(phase.begin(), phase.end());
  *clear = solver::SmoothStep((*most - *least - kNoReach) / (kFullReach - kNoReach));
  const double moment = static_cast<double>(most - phase.begin());
  for (std::size_t t = 0; t < phase.size(); ++t) {
    const double since = (static_cast<double>(t) - moment) / frame_rate_hz;
    phase[t] = static_cast<float>(1 / (1 + std::exp(-since / kChangeSeconds)));
  }
  return phase;
}

// The strength of a class in a frame: `in_time`, 0 to 1, says how far it is the class's time. A
// weight of one half is at its full strength then, and nearly absent otherwise; a weight of 1 is
// there all of the time. `depth`: how much the time matters.
float StrengthOf(float weight, float in_time, float depth) {
  const float most = std::max(weight, std::min(2 * kFullStrength * weight, kFullStrength));
  const float least = std::max(0.0f, weight - (kFullStrength - 1));
  return weight + (least + (most - least) * in_time - weight) * depth;
}

// The leader, held still from the last frame that the window continues from.
Poses HeldStill(Poses leader, int known_frames) {
  const int still = std::max(0, known_frames - 1);
  for (int t = still + 1; t < leader.frame_count(); ++t) {
    std::copy(leader[still].begin(), leader[still].end(), leader[t].begin());
  }
  return leader;
}

double Dot(const Poses& a, const Poses& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.all().size(); ++i)
    sum += double{motion::Dot(a.all()[i], b.all()[i])};
  return sum;
}

Poses Minus(Poses a, const Poses& b) {
  for (std::size_t i = 0; i < a.all().size(); ++i) a.all()[i] = a.all()[i] - b.all()[i];
  return a;
}

}  // namespace

Mixture::Mixture(const ModelDescription& model, const body::Body& body, const NetworkInput& window)
    : frames_(window.leader.frame_count()),
      classes_(model.class_count()),
      root_(model.skeleton.root),
      known_frames_(window.settled.frame_count()),
      reaction_(model.labels_guide ? window.sampling.reaction : 1),
      weights_(window.labels),
      labels_(window.labels) {
  if (model.labels_guide) {
    FindParts(model, body, window);
  } else {
    parts_.push_back(window.labels);
  }
}

void Mixture::FindParts(const ModelDescription& model, const body::Body& body,
                        const NetworkInput& window) {
  Labels contact(weights_.size()), other(weights_.size());
  std::vector<char> avoided(static_cast<std::size_t>(classes_));
  requested_.resize(static_cast<std::size_t>(frames_));
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const std::size_t label = i % static_cast<std::size_t>(classes_);
    if (weights_[i] < 0) avoided[label] = 1;
    const float wanted = std::max(0.0f, weights_[i]);
    (model.IsContact(static_cast<int>(label)) ? contact : other)[i] = wanted;
    requested_[i / static_cast<std::size_t>(classes_)] += wanted;
  }
  for (float& sum : requested_) sum = std::min(1.0f, sum);
  if (!Any(contact) && !Any(other)) {  // nothing is asked for: the network avoids as it has learnt
    parts_.push_back(weights_);
    return;
  }
  const bool both = Any(contact) && Any(other);
  if (both) {
    float clear = 0;
    const std::vector<float> phase =
        PhaseOf(body, root_, window.leader, model.frame_rate_hz, &clear);
    ShareTime(contact, other, phase, clear);
  } else {
    parts_.push_back(Any(contact) ? std::move(contact) : std::move(other));
  }
  for (int label = 0; label < classes_; ++label) {
    if (avoided[static_cast<std::size_t>(label)] != 0) avoided_.push_back(label);
  }
  if (both || !avoided_.empty()) parts_.emplace_back(weights_.size());
  for (const int label : avoided_) {
    Labels alone(weights_.size());
    for (std::size_t i = static_cast<std::size_t>(label); i < alone.size();
         i += static_cast<std::size_t>(classes_)) {
      alone[i] = 1;
    }
    parts_.push_back(std::move(alone));
  }
}

void Mixture::ShareTime(const Labels& contact, const Labels& other, const std::vector<float>& phase,
                        float clear) {
  const std::size_t classes = static_cast<std::size_t>(classes_);
  parts_.assign(2, Labels(weights_.size()));
  for (std::size_t t = 0; t < phase.size(); ++t) {
    const auto sum_of = [&](const Labels& labels) {
      const auto first = labels.begin() + static_cast<std::ptrdiff_t>(t * classes);
      return std::accumulate(first, first + classes_, 0.0f);
    };
    const float contacts = sum_of(contact), others = sum_of(other);
    // A class that is hardly asked for hardly takes the other's time.
    contact_.push_back(StrengthOf(contacts, 1 - phase[t], clear * std::min(1.0f, 2 * others)));
    other_.push_back(StrengthOf(others, phase[t], clear * std::min(1.0f, 2 * contacts)));
    for (std::size_t i = t * classes; i < (t + 1) * classes; ++i) {
      if (contacts > 0) parts_[0][i] = contact[i] / contacts;
      if (others > 0) parts_[1][i] = other[i] / others;
      const float asked = parts_[0][i] * contact_[t] + parts_[1][i] * other_[t];
      labels_[i] = weights_[i] < 0 ? weights_[i] : asked;
    }
  }
}

void Mixture::AddInputs(const NetworkInput& window, std::vector<NetworkInput>* inputs) const {
  const std::size_t first = inputs->size();
  for (const Labels& labels : parts_) {
    inputs->push_back(window);
    inputs->back().labels = labels;
  }
  if (reaction_ == 1) return;
  const Poses still = HeldStill(window.leader, known_frames_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    inputs->push_back((*inputs)[first + i]);
    inputs->back().leader = still;
  }
}

Poses Mixture::Combine(absl::Span<const Poses> answers) const {
  Poses answer = Mix(answers.first(parts_.size()));
  if (reaction_ == 1) return answer;
  const Poses still = Mix(answers.subspan(parts_.size()));
  for (std::size_t i = 0; i < answer.all().size(); ++i) {
    answer.all()[i] = Lerp(still.all()[i], answer.all()[i], reaction_);
  }
  return answer;
}

Poses Mixture::Mix(absl::Span<const Poses> answers) const {
  if (contact_.empty() && avoided_.empty()) return answers[0];
  const std::size_t neutral = contact_.empty() ? 1 : 2;
  Poses answer = contact_.empty() ? answers[0] : InTime(answers[0], answers[1], answers[neutral]);
  Subtract(answers[neutral], answers.subspan(neutral + 1), &answer);
  return answer;
}

// The body's way is that of the answer whose time it is, from where the body is; so is the pose
// about the root.
Poses Mixture::InTime(const Poses& contact, const Poses& other, const Poses& neutral) const {
  Poses mixed = neutral;
  Vec3 place;
  for (int t = 0; t < frames_; ++t) {
    const float first = contact_[static_cast<std::size_t>(t)];
    const float second = other_[static_cast<std::size_t>(t)];
    const auto mix = [=](Vec3 nothing, Vec3 touch, Vec3 rest) {
      return nothing + (touch - nothing) * first + (rest - nothing) * second;
    };
    const Vec3 root = mix(neutral.at(t, root_), contact.at(t, root_), other.at(t, root_));
    if (t < std::max(1, known_frames_)) {
      place = root;
    } else {
      const auto way = [&](const Poses& of) { return of.at(t, root_) - of.at(t - 1, root_); };
      place += mix(way(neutral), way(contact), way(other));
      place.y = root.y;
    }
    for (int j = 0; j < mixed.joint_count(); ++j) {
      const auto from_root = [&](const Poses& of) { return of.at(t, j) - of.at(t, root_); };
      mixed.at(t, j) = place + mix(from_root(neutral), from_root(contact), from_root(other));
    }
  }
  return mixed;
}

void Mixture::Subtract(const Poses& neutral, absl::Span<const Poses> avoided, Poses* answer) const {
  const Poses request = Minus(*answer, neutral);
  const double squared = Dot(request, request);
  for (std::size_t k = 0; k < avoided.size(); ++k) {
    const Poses whole = Minus(avoided[k], neutral);
    const double along = squared > 0 ? Dot(whole, request) / squared : 0;
    const double across = std::max(0.0, Dot(whole, whole) - along * along * squared);
    const double kept =
        across > 0 ? std::min(1.0, kMostAvoided * std::sqrt(squared / across)) : 1.0;
    for (int t = 0; t < frames_; ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      const float weight = std::min(0.0f, weights_[at * static_cast<std::size_t>(classes_) +
                                                   static_cast<std::size_t>(avoided_[k])]);
      const float asked = requested_[at];
      const float of_whole = 1 - asked + asked * static_cast<float>(kept);
      const float of_request = asked * static_cast<float>(kept * along);
      for (int j = 0; j < answer->joint_count(); ++j) {
        answer->at(t, j) += (whole.at(t, j) * of_whole - request.at(t, j) * of_request) * weight;
      }
    }
  }
}

}  // namespace duet::engine
