#include "model/retargeting/joint_mapping.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "model/retargeting/joint_names.h"

namespace duet::retargeting {
namespace {

constexpr std::size_t kMostNamesInError = 60;
// Shares of the way from hips to neck. How far from its middle a spine joint may be to stand for
// the torso; the shortest head with an end of its own; how near to the neck a head's joint is that
// stands at the base of the skull; how far above that the middle of the head is.
constexpr float kTorsoReach = 0.25f;
constexpr float kShortestHead = 0.1f;
constexpr float kShortestNeck = 0.05f, kLongestNeck = 0.35f;
constexpr float kHeadRise = 0.19f;

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

motion::Vec3 Evaluate(const JointSource& source, absl::Span<const motion::Vec3> pose) {
  motion::Vec3 position;
  for (const JointSource::Term& term : source.terms) {
    position += pose[static_cast<size_t>(term.joint)] * term.weight;
  }
  return position;
}

class Mapper {
 public:
  Mapper(absl::string_view source, const std::vector<std::string>& names,
         absl::Span<const motion::Vec3> first_pose, const motion::Skeleton& skeleton)
      : source_(source), names_(names), pose_(first_pose), skeleton_(skeleton) {
    found_.resize(skeleton.joint_names.size());
    overridden_.resize(skeleton.joint_names.size(), false);
    used_.resize(names.size(), false);
    for (const std::string& name : names) parsed_.push_back(ParseJointName(name));
  }

  absl::Status ApplyOverrides(const JointOverrides& overrides) {
    for (const auto& [target, name] : overrides) {
      const int joint = skeleton_.Find(target);
      if (joint < 0) {
        return absl::InvalidArgumentError(
            absl::StrCat("joint map: came target ", base::Quoted(target),
                         ", wanted one of: ", absl::StrJoin(skeleton_.joint_names, ", ")));
      }
      const int index = FindExactly(name);
      if (index < 0) {
        return absl::InvalidArgumentError(absl::StrCat(
            "joint map: ", target, "=", name, ": ", source_, " has no such joint; ", ListNames()));
      }
      Take(joint, index);
      overridden_[static_cast<size_t>(joint)] = true;
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
      if (!Found(joint) && !IsPlaced(joint)) MapByAlias(joint);
    }
    PlaceNeck();
    PlaceTorso();
    RaiseHead();
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
  // Neck and torso go by where they are: conventions differ in how many joints a spine has.
  bool IsPlaced(int joint) const {
    return joint == skeleton_.Find("neck") || joint == skeleton_.Find("torso");
  }

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

  // The unused joint nearest to `point` and within `reach` of it for which `fits` holds, or -1.
  template <typename Fits>
  int FindNearest(motion::Vec3 point, float reach, Fits fits) const {
    int best = -1;
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (used_[i] || !fits(parsed_[i]) || Distance(pose_[i], point) > reach) continue;
      best = static_cast<int>(i);
      reach = Distance(pose_[i], point);
    }
    return best;
  }

  void PlaceNeck() {
    const int neck = skeleton_.Find("neck");
    const int left = skeleton_.Find("left_shoulder"), right = skeleton_.Find("right_shoulder");
    if (neck < 0 || Found(neck)) return;
    if (!Found(left) || !Found(right)) return MapByAlias(neck);
    const JointSource middle = Mix({{&SourceOf(left), 0.5f}, {&SourceOf(right), 0.5f}});
    const float width = Distance(PositionOf(SourceOf(left)), PositionOf(SourceOf(right)));
    const int best = FindNearest(PositionOf(middle), width, IsNeck);
    if (best >= 0) {
      Take(neck, best);
      Note("neck", best, "the neck joint nearest to half way between the shoulders");
    } else {
      found_[static_cast<size_t>(neck)] = middle;
      notes_.push_back("neck: half way between the shoulders (no neck joint is near)");
    }
  }

  void PlaceTorso() {
    const int neck = skeleton_.Find("neck"), torso = skeleton_.Find("torso");
    if (torso < 0 || Found(torso)) return;
    if (!HasSpineEnds()) return MapByAlias(torso);
    const JointSource middle = Mix({{&SourceOf(neck), 0.5f},
                                    {&SourceOf(skeleton_.hips->left), 0.25f},
                                    {&SourceOf(skeleton_.hips->right), 0.25f}});
    const int best = FindNearest(PositionOf(middle), kTorsoReach * SpineLength(), IsSpine);
    if (best >= 0) {
      Take(torso, best);
      Note("torso", best, "the spine joint nearest to half way from hips to neck");
    } else {
      found_[static_cast<size_t>(torso)] = middle;
      notes_.push_back("torso: half way from hips to neck (no spine joint is near)");
    }
  }

  // Capture software puts the head's joint at the base of the skull; the skeleton's is its middle,
  // half way to the end of the head. A file without that end gives the neck's direction.
  void RaiseHead() {
    const int head = skeleton_.Find("head"), neck = skeleton_.Find("neck");
    if (!Found(head) || overridden_[static_cast<size_t>(head)] || !HasSpineEnds()) return;
    const JointSource base = SourceOf(head);
    const motion::Vec3 at = PositionOf(base);
    for (const char* end : {"headend", "headtopend", "headtop"}) {
      const int index = FindUnused({BodySide::kMiddle, end});
      if (index < 0) continue;
      if (Distance(at, pose_[static_cast<size_t>(index)]) < kShortestHead * SpineLength()) continue;
      const JointSource top = Whole(index);
      SourceOf(head) = Mix({{&base, 0.5f}, {&top, 0.5f}});
      return Note("head", index, "half way to it from the head's joint");
    }
    const float way = Distance(at, PositionOf(SourceOf(neck))) / SpineLength();
    if (!(way > kShortestNeck && way < kLongestNeck)) return;
    const float rise = kHeadRise / way;
    SourceOf(head) = Mix({{&base, 1 + rise}, {&SourceOf(neck), -rise}});
    notes_.push_back("head: raised from the base of the skull to its middle, away from the neck");
  }

  bool HasSpineEnds() const {
    return skeleton_.hips && Found(skeleton_.Find("neck")) && Found(skeleton_.hips->left) &&
           Found(skeleton_.hips->right);
  }

  // Hips to neck in the first frame; HasSpineEnds.
  float SpineLength() {
    const JointSource hips =
        Mix({{&SourceOf(skeleton_.hips->left), 0.5f}, {&SourceOf(skeleton_.hips->right), 0.5f}});
    return Distance(PositionOf(hips), PositionOf(SourceOf(skeleton_.Find("neck"))));
  }

  void Note(const char* target, int index, const char* reason) {
    notes_.push_back(
        absl::StrCat(target, ": ", names_[static_cast<size_t>(index)], " (", reason, ")"));
  }

  motion::Vec3 PositionOf(const JointSource& source) const { return Evaluate(source, pose_); }

  absl::string_view source_;
  const std::vector<std::string>& names_;
  absl::Span<const motion::Vec3> pose_;
  const motion::Skeleton& skeleton_;
  std::vector<ParsedJointName> parsed_;            // [names]
  std::vector<bool> used_;                         // [names]
  std::vector<std::optional<JointSource>> found_;  // [skeleton joints]
  std::vector<bool> overridden_;                   // [skeleton joints] named by the user
  std::vector<std::string> notes_;
};

}  // namespace

absl::StatusOr<JointMap> MapJoints(absl::string_view source, const std::vector<std::string>& names,
                                   absl::Span<const motion::Vec3> first_pose,
                                   const motion::Skeleton& skeleton,
                                   const JointOverrides& overrides) {
  Mapper mapper(source, names, first_pose, skeleton);
  absl::Status status = mapper.ApplyOverrides(overrides);
  if (!status.ok()) return status;
  if (!mapper.MapIdentity()) mapper.MapByConvention();
  return mapper.Finish();
}

std::vector<motion::Vec3> ApplyJointMap(const JointMap& map, absl::Span<const motion::Vec3> pose) {
  std::vector<motion::Vec3> mapped;
  mapped.reserve(map.sources.size());
  for (const JointSource& source : map.sources) mapped.push_back(Evaluate(source, pose));
  return mapped;
}

}  // namespace duet::retargeting
