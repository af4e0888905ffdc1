#include "model/formats/joint_mapping.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/formats/joint_names.h"
#include "model/formats/text.h"

namespace duet {
namespace {

constexpr std::size_t kMostNamesInError = 60;
// How far from half way between hips and neck a spine joint may be to stand for the torso, as a
// share of the way.
constexpr float kTorsoTolerance = 0.25f;

JointSource Whole(int joint) { return {{{joint, 1.0f}}}; }

// The mean of several sources, each of weight `weights`.
JointSource Mix(std::initializer_list<std::pair<const JointSource*, float>> parts) {
  JointSource mixed;
  for (const auto& [part, weight] : parts) {
    for (const JointSource::Term& term : part->terms) {
      mixed.terms.push_back({term.joint, term.weight * weight});
    }
  }
  return mixed;
}

Vec3 PositionOf(const JointSource& source, const std::vector<Vec3>& pose) {
  Vec3 position;
  for (const JointSource::Term& term : source.terms) {
    position += pose[static_cast<size_t>(term.joint)] * term.weight;
  }
  return position;
}

class Mapper {
 public:
  Mapper(absl::string_view source, const std::vector<std::string>& names,
         const std::vector<Vec3>& first_pose, const Skeleton& skeleton)
      : source_(source), names_(names), pose_(first_pose), skeleton_(skeleton) {
    found_.resize(skeleton.joint_names.size());
    used_.resize(names.size(), false);
    for (const std::string& name : names) parsed_.push_back(ParseJointName(name));
  }

  absl::Status ApplyOverrides(const JointOverrides& overrides) {
    for (const auto& [target, name] : overrides) {
      const int joint = skeleton_.Find(target);
      if (joint < 0) {
        return absl::InvalidArgumentError(
            absl::StrCat("joint map: came target ", Quoted(target),
                         ", wanted one of: ", absl::StrJoin(skeleton_.joint_names, ", ")));
      }
      const int index = FindExactly(name);
      if (index < 0) {
        return absl::InvalidArgumentError(absl::StrCat(
            "joint map: ", target, "=", name, ": ", source_, " has no such joint; ", ListNames()));
      }
      Take(joint, index);
    }
    return absl::OkStatus();
  }

  // All names as the skeleton has them: nothing to decide.
  bool MapIdentity() {
    std::vector<int> indices;
    for (const std::string& name : skeleton_.joint_names) indices.push_back(FindExactly(name));
    if (std::count(indices.begin(), indices.end(), -1) > 0) return false;
    for (std::size_t joint = 0; joint < indices.size(); ++joint) {
      if (!found_[joint].has_value()) found_[joint] = Whole(indices[joint]);
    }
    return true;
  }

  void MapByConvention() {
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      if (!Found(joint) && !IsTorso(joint)) MapByAlias(joint);
    }
    RaiseHead();
    PlaceNeck();
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      if (!Found(joint) && IsTorso(joint)) PlaceTorso(joint);
    }
  }

  absl::StatusOr<JointMap> Finish() {
    std::vector<std::string> missing;
    JointMap map;
    for (std::size_t joint = 0; joint < found_.size(); ++joint) {
      if (!found_[joint].has_value()) {
        missing.push_back(skeleton_.joint_names[joint]);
      } else {
        map.sources.push_back(*std::move(found_[joint]));
      }
    }
    map.notes = std::move(notes_);
    if (missing.empty()) return map;
    return absl::InvalidArgumentError(
        absl::StrCat(source_, ": joints: nothing stands for ", absl::StrJoin(missing, ", "), "; ",
                     ListNames(), "; say which with a joint map such as ", missing[0], "=NAME"));
  }

 private:
  bool Found(int joint) const {
    return joint >= 0 && found_[static_cast<size_t>(joint)].has_value();
  }
  JointSource& SourceOf(int joint) { return *found_[static_cast<size_t>(joint)]; }
  const std::string& TargetName(int joint) const {
    return skeleton_.joint_names[static_cast<size_t>(joint)];
  }
  bool IsTorso(int joint) const { return TargetName(joint) == "torso"; }

  int FindExactly(absl::string_view name) const {
    const auto it = std::find(names_.begin(), names_.end(), name);
    return it == names_.end() ? -1 : static_cast<int>(it - names_.begin());
  }

  int FindUnused(const ParsedJointName& wanted) const {
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (!used_[i] && parsed_[i] == wanted) return static_cast<int>(i);
    }
    return -1;
  }

  void Take(int joint, int index) {
    used_[static_cast<size_t>(index)] = true;
    found_[static_cast<size_t>(joint)] = Whole(index);
  }

  std::string ListNames() const {
    const std::size_t shown = std::min(names_.size(), kMostNamesInError);
    const std::vector<std::string> some(names_.begin(),
                                        names_.begin() + static_cast<std::ptrdiff_t>(shown));
    return absl::StrCat("the file has ", absl::StrJoin(some, ", "),
                        shown < names_.size() ? ", ..." : "");
  }

  void MapByAlias(int joint) {
    const ParsedJointName target = ParseJointName(TargetName(joint));
    for (const std::string& alias : JointAliases(target.base)) {
      // A skeleton with both wrist and hand keeps each for its own.
      const bool other_target = alias != target.base && IsTarget({target.side, alias});
      const int index = other_target ? -1 : FindUnused({target.side, alias});
      if (index < 0) continue;
      Take(joint, index);
      return;
    }
  }

  bool IsTarget(const ParsedJointName& name) const {
    return std::any_of(
        skeleton_.joint_names.begin(), skeleton_.joint_names.end(),
        [&name](const std::string& target) { return ParseJointName(target) == name; });
  }

  // Capture software puts the head's joint at the base of the skull; the skeleton's is its middle,
  // half way to the end of the head where the file has one.
  void RaiseHead() {
    const int head = skeleton_.Find("head");
    if (!Found(head)) return;
    for (const char* end : {"headend", "headtopend", "headtop"}) {
      const int index = FindUnused({BodySide::kMiddle, end});
      if (index < 0) continue;
      const JointSource base = SourceOf(head), top = Whole(index);
      SourceOf(head) = Mix({{&base, 0.5f}, {&top, 0.5f}});
      notes_.push_back(absl::StrCat("head: half way from ", NameOf(base), " to ", NameOf(top)));
      return;
    }
  }

  void PlaceNeck() {
    const int neck = skeleton_.Find("neck");
    const int left = skeleton_.Find("left_shoulder"), right = skeleton_.Find("right_shoulder");
    if (neck < 0 || Found(neck) || !Found(left) || !Found(right)) return;
    found_[static_cast<size_t>(neck)] = Mix({{&SourceOf(left), 0.5f}, {&SourceOf(right), 0.5f}});
    notes_.push_back("neck: half way between the shoulders (the file has none)");
  }

  void PlaceTorso(int joint) {
    const int neck = skeleton_.Find("neck");
    if (!Found(neck) || !Found(skeleton_.left_hip) || !Found(skeleton_.right_hip)) return;
    const JointSource middle = Mix({{&SourceOf(neck), 0.5f},
                                    {&SourceOf(skeleton_.left_hip), 0.25f},
                                    {&SourceOf(skeleton_.right_hip), 0.25f}});
    const Vec3 half_way = PositionOf(middle, pose_);
    const float way = 2 * Distance(half_way, PositionOf(SourceOf(neck), pose_));
    int best = -1;
    float best_distance = kTorsoTolerance * way;
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (used_[i] || !IsSpine(parsed_[i])) continue;
      const float distance = Distance(pose_[i], half_way);
      if (distance > best_distance) continue;
      best = static_cast<int>(i);
      best_distance = distance;
    }
    if (best >= 0) {
      Take(joint, best);
      notes_.push_back(absl::StrCat("torso: ", names_[static_cast<size_t>(best)],
                                    " (the spine joint nearest to half way from hips to neck)"));
    } else {
      found_[static_cast<size_t>(joint)] = middle;
      notes_.push_back("torso: half way from hips to neck (no spine joint is near)");
    }
  }

  const std::string& NameOf(const JointSource& source) const {
    return names_[static_cast<size_t>(source.terms[0].joint)];
  }

  absl::string_view source_;
  const std::vector<std::string>& names_;
  const std::vector<Vec3>& pose_;
  const Skeleton& skeleton_;
  std::vector<ParsedJointName> parsed_;            // [names]
  std::vector<bool> used_;                         // [names]
  std::vector<std::optional<JointSource>> found_;  // [skeleton joints]
  std::vector<std::string> notes_;
};

}  // namespace

absl::StatusOr<JointMap> MapJoints(absl::string_view source, const std::vector<std::string>& names,
                                   const std::vector<Vec3>& first_pose, const Skeleton& skeleton,
                                   const JointOverrides& overrides) {
  Mapper mapper(source, names, first_pose, skeleton);
  absl::Status status = mapper.ApplyOverrides(overrides);
  if (!status.ok()) return status;
  if (!mapper.MapIdentity()) mapper.MapByConvention();
  return mapper.Finish();
}

std::vector<Vec3> ApplyJointMap(const JointMap& map, const Vec3* pose) {
  std::vector<Vec3> mapped;
  mapped.reserve(map.sources.size());
  for (const JointSource& source : map.sources) {
    Vec3 position;
    for (const JointSource::Term& term : source.terms) position += pose[term.joint] * term.weight;
    mapped.push_back(position);
  }
  return mapped;
}

}  // namespace duet
