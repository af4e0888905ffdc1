#include "model/authoring/keyframes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/authoring/puppet.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"
#include "model/motion/skeleton.h"

namespace duet::authoring {
namespace {

// Interpolates a value over time through keys. It starts and ends at rest, has a continuous
// velocity, and never leaves the range of the two neighbouring keys (a planted foot stays planted,
// a reach does not overshoot). It is constant before the first key and after the last.
//
// Source: Fritsch and Carlson 1980, with the harmonic mean of the neighbouring slopes.
class MonotoneCubic {
 public:
  struct Key {
    double time = 0;
    double value = 0;
  };
  // Requires at least one key, with strictly increasing times.
  explicit MonotoneCubic(std::vector<Key> keys);
  double At(double time) const;

 private:
  std::vector<Key> keys_;
  std::vector<double> slopes_;  // [keys]
};

MonotoneCubic::MonotoneCubic(std::vector<Key> keys)
    : keys_(std::move(keys)), slopes_(keys_.size(), 0.0) {
  for (std::size_t k = 1; k + 1 < keys_.size(); ++k) {
    const double before =
        (keys_[k].value - keys_[k - 1].value) / (keys_[k].time - keys_[k - 1].time);
    const double after =
        (keys_[k + 1].value - keys_[k].value) / (keys_[k + 1].time - keys_[k].time);
    // Zero at a turning point; elsewhere the harmonic mean, which the flatter side dominates.
    if (before * after > 0) slopes_[k] = 2 * before * after / (before + after);
  }
}

double MonotoneCubic::At(double time) const {
  if (time <= keys_.front().time) return keys_.front().value;
  if (time >= keys_.back().time) return keys_.back().value;
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                      [](double t, const Key& key) { return t < key.time; });
  const std::size_t k = static_cast<std::size_t>(after - keys_.begin()) - 1;
  const Key& a = keys_[k];
  const Key& b = keys_[k + 1];
  const double span = b.time - a.time, t = (time - a.time) / span;
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a.value + (t3 - 2 * t2 + t) * span * slopes_[k] +
         (3 * t2 - 2 * t3) * b.value + (t3 - t2) * span * slopes_[k + 1];
}

constexpr double kLongestMotion = 60;
constexpr double kDefaultFrameRateHz = 30;

// The values of a pose that a track sets.
using Values = std::vector<double*>;
Values Of(retargeting::Vec3d& v) { return {&v.x, &v.y, &v.z}; }
Values Of(Lean& lean) { return {&lean.yaw, &lean.pitch, &lean.roll}; }

struct Track {
  const char* name;
  Values (*values)(PuppetPose& pose);
};
constexpr Track kTracks[] = {
    {"torso", [](PuppetPose& pose) { return Of(pose.torso); }},
    {"pelvis", [](PuppetPose& pose) { return Of(pose.pelvis); }},
    {"chest", [](PuppetPose& pose) { return Of(pose.chest); }},
    {"head", [](PuppetPose& pose) { return Of(pose.head); }},
    {"left_foot", [](PuppetPose& pose) { return Of(pose.left_foot.target); }},
    {"right_foot", [](PuppetPose& pose) { return Of(pose.right_foot.target); }},
    {"left_hand", [](PuppetPose& pose) { return Of(pose.left_hand.target); }},
    {"right_hand", [](PuppetPose& pose) { return Of(pose.right_hand.target); }},
    {"left_elbow", [](PuppetPose& pose) { return Values{&pose.left_hand.swivel}; }},
    {"right_elbow", [](PuppetPose& pose) { return Values{&pose.right_hand.swivel}; }},
    {"left_knee", [](PuppetPose& pose) { return Values{&pose.left_foot.swivel}; }},
    {"right_knee", [](PuppetPose& pose) { return Values{&pose.right_foot.swivel}; }}};

PuppetPose RelaxedStand() {
  PuppetPose pose;
  pose.torso = {0, 1.11, 0};
  pose.chest.pitch = 2;
  pose.left_foot = {{0.11, 0.08, 0.02}, 6};
  pose.right_foot = {{-0.11, 0.08, -0.02}, 6};
  pose.left_hand = {{0.21, -0.55, 0.05}, 20};
  pose.right_hand = {{-0.21, -0.55, 0.05}, 20};
  return pose;
}

// The keys of one track, for each of its values.
using TrackKeys = std::vector<std::vector<MonotoneCubic::Key>>;

class KeyframeParser {
 public:
  KeyframeParser(absl::string_view text, absl::string_view source) : lines_(text), source_(source) {
    PuppetPose pose;
    for (const Track& track : kTracks) keys_.emplace_back(track.values(pose).size());
  }

  absl::Status Parse() {
    for (absl::string_view line; lines_.Next(&line);) {
      line = line.substr(0, line.find('#'));
      const std::vector<absl::string_view> words =
          absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
      if (words.empty()) continue;
      absl::Status status = ParseStatement(words);
      if (!status.ok()) return status;
    }
    if (time_ > 0) return absl::OkStatus();
    return Error("at: expected at least two key poses, got no time after 0 s");
  }

  double frame_rate_hz() const { return frame_rate_hz_; }

  // The pose at each frame.
  std::vector<PuppetPose> Poses() const {
    const int frames = 1 + static_cast<int>(std::round(time_ * frame_rate_hz_));
    std::vector<PuppetPose> poses(static_cast<std::size_t>(frames), RelaxedStand());
    for (std::size_t track = 0; track < keys_.size(); ++track) {
      for (std::size_t i = 0; i < keys_[track].size(); ++i) {
        if (keys_[track][i].empty()) continue;
        const MonotoneCubic curve(keys_[track][i]);
        for (int frame = 0; frame < frames; ++frame) {
          PuppetPose& pose = poses[static_cast<std::size_t>(frame)];
          *kTracks[track].values(pose)[i] = curve.At(frame / frame_rate_hz_);
        }
      }
    }
    return poses;
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, std::max(lines_.number(), 1), message);
  }

  absl::Status ParseStatement(const std::vector<absl::string_view>& words) {
    if (words[0] == "frame_rate") return ParseFrameRate(words);
    if (words[0] == "at") return ParseTime(words);
    for (std::size_t track = 0; track < keys_.size(); ++track) {
      if (words[0] == kTracks[track].name) return ParseKey(words, track);
    }
    return Error(absl::StrCat("expected frame_rate, at or a track such as torso, got ",
                              base::Quoted(words[0])));
  }

  absl::Status ParseValues(const std::vector<absl::string_view>& words, std::size_t expected,
                           std::vector<double>* values) const {
    for (std::size_t i = 1; i < words.size(); ++i) {
      float value = 0;
      if (!motion::ParseCoordinate(words[i], &value)) {
        return Error(absl::StrCat(words[0], ": ", motion::ExpectedCoordinate(words[i])));
      }
      values->push_back(static_cast<double>(value));
    }
    if (values->size() == expected) return absl::OkStatus();
    return Error(absl::StrCat(words[0], ": expected ", expected, " values, got ", values->size()));
  }

  absl::Status ParseFrameRate(const std::vector<absl::string_view>& words) {
    std::vector<double> values;
    absl::Status status = ParseValues(words, 1, &values);
    if (!status.ok()) return status;
    if (values[0] < 1 || values[0] > motion::kMaxServedFrameRateHz) {
      return Error(absl::StrCat("frame_rate: expected 1 to ", motion::kMaxServedFrameRateHz,
                                ", got ", values[0]));
    }
    frame_rate_hz_ = values[0];
    return absl::OkStatus();
  }

  absl::Status ParseTime(const std::vector<absl::string_view>& words) {
    std::vector<double> values;
    absl::Status status = ParseValues(words, 1, &values);
    if (!status.ok()) return status;
    if (time_ < 0 ? values[0] != 0 : values[0] <= time_ || values[0] > kLongestMotion) {
      return Error(absl::StrCat(
          "at: expected ",
          time_ < 0 ? "0 first"
                    : absl::StrCat("more than ", time_, " and at most ", kLongestMotion),
          ", got ", values[0]));
    }
    time_ = values[0];
    return absl::OkStatus();
  }

  absl::Status ParseKey(const std::vector<absl::string_view>& words, std::size_t track) {
    if (time_ < 0) return Error(absl::StrCat("expected \"at 0\" first, got ", words[0]));
    std::vector<double> values;
    absl::Status status = ParseValues(words, keys_[track].size(), &values);
    if (!status.ok()) return status;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::vector<MonotoneCubic::Key>& keys = keys_[track][i];
      if (!keys.empty() && keys.back().time == time_) {
        return Error(absl::StrCat(words[0], ": expected one key at ", time_, " s, got two"));
      }
      keys.push_back({time_, values[i]});
    }
    return absl::OkStatus();
  }

  base::LineReader lines_;
  absl::string_view source_;
  double frame_rate_hz_ = kDefaultFrameRateHz;
  double time_ = -1;
  std::vector<TrackKeys> keys_;  // [tracks]
};

}  // namespace

absl::StatusOr<motion::Clip> ParseKeyframes(absl::string_view text, absl::string_view source) {
  KeyframeParser parser(text, source);
  absl::Status status = parser.Parse();
  if (!status.ok()) return status;
  motion::Clip clip;
  clip.joint_names = motion::SbuSkeleton().joint_names;
  clip.frame_rate_hz = parser.frame_rate_hz();
  for (const PuppetPose& pose : parser.Poses()) clip.Append(PosePuppet(pose));
  return clip;
}

}  // namespace duet::authoring
