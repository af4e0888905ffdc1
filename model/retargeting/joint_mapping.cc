#include "model/retargeting/joint_mapping.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/types/span.h"
#include "model/base/index.h"
#include "model/base/text.h"
#include "model/motion/reading_setting.h"
#include "model/retargeting/joint_names.h"

namespace duet::retargeting {
namespace {

constexpr Vec3d kLeft = {1, 0, 0}, kRight = {-1, 0, 0}, kUp = {0, 1, 0}, kDown = {0, -1, 0};

using base::Index;

// Joints that define a character's proportions, as indices into its tree.
struct Landmarks {
  int head = -1;
  std::optional<motion::JointPair> shoulders, hips;
};

// The joint positions of a straightened character (JointMap::straight). They depend only on bone
// lengths, so that they are equal for every clip of a rig and independent of its rest pose. The
// origin is the joint where legs and trunk meet. [names]
class StraightFigure {
 public:
  StraightFigure(const JointTree& tree, const Landmarks& landmarks)
      : tree_(tree), landmarks_(landmarks), places_(tree.names.size()) {}

  std::vector<motion::Vec3> Build() {
    for (std::size_t j = 0; j < places_.size(); ++j) {
      if (tree_.parents[j] >= 0) places_[j] = PlaceAfterParent(j, kUp);
    }
    const int base = Base();
    if (base >= 0) {
      const Vec3d origin = places_[Index(base)];
      for (Vec3d& place : places_) place = place - origin;
      if (landmarks_.hips) PlaceLimbs(*landmarks_.hips, base, kDown, kDown, kDown);
    }
    if (landmarks_.shoulders) {
      const motion::JointPair& shoulders = *landmarks_.shoulders;
      const int chest = CommonAncestor(tree_.parents, shoulders.left, shoulders.right);
      if (chest >= 0) PlaceLimbs(shoulders, chest, kUp, kLeft, kRight);
    }
    std::vector<motion::Vec3> straight;
    straight.reserve(places_.size());
    for (const Vec3d& place : places_) straight.push_back(ToFloat(place));
    return straight;
  }

 private:
  Vec3d PlaceAfterParent(std::size_t joint, Vec3d direction) const {
    return places_[Index(tree_.parents[joint])] + direction * Norm(tree_.offsets[joint]);
  }

  // The joint at which legs and trunk separate; -1 without hips.
  int Base() const {
    if (!landmarks_.hips) return -1;
    const int pelvis = CommonAncestor(tree_.parents, landmarks_.hips->left, landmarks_.hips->right);
    const int top = landmarks_.shoulders ? landmarks_.shoulders->left : landmarks_.head;
    if (pelvis < 0 || top < 0) return pelvis;
    return CommonAncestor(tree_.parents, pelvis, top);
  }

  Vec3d Offset(int ancestor, int joint) const {
    Vec3d sum;
    for (; joint != ancestor; joint = tree_.parents[Index(joint)]) {
      sum += tree_.offsets[Index(joint)];
    }
    return sum;
  }

  // Places both limbs of a pair whose middle is in the direction of `middle` from `ancestor`.
  void PlaceLimbs(motion::JointPair starts, int ancestor, Vec3d middle, Vec3d left, Vec3d right) {
    const Vec3d to_left = Offset(ancestor, starts.left), to_right = Offset(ancestor, starts.right);
    const Vec3d centre = places_[Index(ancestor)] + middle * (Norm(to_left + to_right) / 2);
    const double half_width = Norm(to_left - to_right) / 2;
    PlaceLimb(starts.left, centre + kLeft * half_width, left);
    PlaceLimb(starts.right, centre + kRight * half_width, right);
  }

  void PlaceLimb(int start, Vec3d at, Vec3d direction) {
    places_[Index(start)] = at;
    for (std::size_t j = Index(start) + 1; j < places_.size(); ++j) {
      if (!IsAtOrBelow(tree_.parents, static_cast<int>(j), start)) continue;
      places_[j] = PlaceAfterParent(j, direction);
    }
  }

  const JointTree& tree_;
  const Landmarks landmarks_;
  std::vector<Vec3d> places_;  // [names]
};

}  // namespace

bool IsAtOrBelow(const std::vector<int>& parents, int joint, int ancestor) {
  while (joint >= 0 && joint != ancestor) joint = parents[Index(joint)];
  return joint == ancestor;
}

int CommonAncestor(const std::vector<int>& parents, int a, int b) {
  while (a >= 0 && !IsAtOrBelow(parents, b, a)) a = parents[Index(a)];
  return a;
}

namespace {

constexpr std::size_t kMostNamesInError = 60;
// Fractions of the distance from hips to neck: the maximum distance of a torso joint from the
// middle; the minimum length of a head with an end; the maximum distance from the neck of a head
// joint at the base of the skull; the height of the middle of the head above that joint.
constexpr float kTorsoReach = 0.25f;
constexpr float kShortestHead = 0.1f;
constexpr float kShortestNeck = 0.05f, kLongestNeck = 0.35f;
constexpr float kHeadRise = 0.19f;
// Of a skeleton with several joints in the trunk: the heights of hips and chest on the way from the
// middle of the hip joints to the neck, and that of the spine on the way to the chest; the top of
// the head above its joint, as a fraction of the distance from hips to neck; the way of the
// knuckles beyond the wrist, as a fraction of the forearm.
constexpr float kHipsHeight = 0.23f, kChestHeight = 0.77f, kSpineHeight = 0.6f;
constexpr float kHeadTopRise = 0.22f;
constexpr float kHandReach = 0.3f;
// Number of frames, spread over the motion, over which distances are averaged.
constexpr int kMeasuredFrames = 100;

JointSource Whole(int joint) { return {{{joint, 1.0f}}}; }

// The weighted mean of several sources.
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

// Frames spread evenly over a motion.
std::vector<absl::Span<const motion::Vec3>> Spread(const motion::Poses& poses) {
  const int count = std::min(poses.frame_count(), kMeasuredFrames);
  std::vector<absl::Span<const motion::Vec3>> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(poses[static_cast<int>(int64_t{i} * poses.frame_count() / count)]);
  }
  return frames;
}

class Mapper {
 public:
  Mapper(absl::string_view source, const std::vector<std::string>& names,
         const motion::Skeleton& skeleton, std::vector<JointReading>* readings)
      : source_(source),
        names_(names),
        parsed_(ParseJointNames(names)),
        skeleton_(skeleton),
        readings_(readings) {
    found_.resize(skeleton.joint_names.size());
    why_.resize(skeleton.joint_names.size());
    // MakeHuman's helpers (`__UpLeg_L` above `UpLeg_L`) have the names of joints.
    for (const std::string& name : names) used_.push_back(absl::StartsWith(name, "__"));
  }

  // Distances are those of the straightened tree, or means over `poses` if there is no tree.
  absl::StatusOr<JointMap> Map(const JointTree* tree, const motion::Poses& poses,
                               const JointOverrides& overrides, MissingToes missing_toes) {
    absl::Status status = ApplyOverrides(overrides);
    if (!status.ok()) return status;
    const bool identical = MapIdentity();
    if (!identical) MapAliases();
    if (missing_toes == MissingToes::kAtTheFeet) PlaceMissingToes();
    std::vector<motion::Vec3> straight;
    if (tree != nullptr) straight = StraightFigure(*tree, FindLandmarks()).Build();
    measured_ = tree != nullptr ? std::vector{absl::MakeConstSpan(straight)} : Spread(poses);
    if (!identical) PlaceTrunk();
    absl::StatusOr<JointMap> map = Finish();
    if (map.ok() && tree != nullptr) map->straight = ApplyJointMap(*map, straight);
    return map;
  }

 private:
  absl::Status ApplyOverrides(const JointOverrides& overrides) {
    for (const auto& [target, name] : overrides) {
      const int joint = skeleton_.Find(target);
      if (joint < 0) {
        return absl::InvalidArgumentError(absl::StrCat("joint map: target: expected one of ",
                                                       absl::StrJoin(skeleton_.joint_names, ", "),
                                                       ", got ", base::Quoted(target)));
      }
      const int index = FindExactly(name);
      if (index < 0) {
        return absl::InvalidArgumentError(absl::StrCat(
            "joint map: ", target, "=", name, ": ", source_, " has no such joint; ", ListNames()));
      }
      Take(joint, index);
      given_.insert(joint);
    }
    return absl::OkStatus();
  }

  // Whether the file has exactly the skeleton's names.
  bool MapIdentity() {
    std::vector<int> indices;
    for (const std::string& name : skeleton_.joint_names) indices.push_back(FindExactly(name));
    if (std::count(indices.begin(), indices.end(), -1) > 0) return false;
    for (std::size_t joint = 0; joint < indices.size(); ++joint) {
      if (!found_[joint].has_value()) found_[joint] = Whole(indices[joint]);
    }
    return true;
  }

  void MapAliases() {
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      if (!Found(joint) && !IsPlaced(joint)) MapByAlias(joint);
    }
    for (const char* side : {"left", "right"}) MapWristAndHand(side);
  }

  // Most files call the wrist a hand. A skeleton with both then has its hand at the knuckles: the
  // base of the middle finger, the end of the file's hand, or a point beyond the wrist.
  void MapWristAndHand(const std::string& side) {
    const int wrist = skeleton_.Find(side + "_wrist"), hand = skeleton_.Find(side + "_hand");
    const int elbow = skeleton_.Find(side + "_elbow");
    if (wrist < 0 || hand < 0) return;
    const BodySide of = side == "left" ? BodySide::kLeft : BodySide::kRight;
    if (!Found(wrist) && given_.count(hand) > 0) {
      if (const int index = FindUnused({of, "hand"}); index >= 0) Take(wrist, index);
    } else if (!Found(wrist) && Found(hand)) {
      std::swap(found_[static_cast<size_t>(wrist)], found_[static_cast<size_t>(hand)]);
      Note(wrist, "the file's hand begins at the wrist");
    }
    if (Found(hand) || !Found(wrist) || !Found(elbow)) return;
    for (const char* end : {"handmiddle1", "middle1", "middle01", "handend", "wristend"}) {
      if (const int index = FindUnused({of, end}); index >= 0) return Take(hand, index);
    }
    found_[static_cast<size_t>(hand)] =
        Mix({{&SourceOf(wrist), 1 + kHandReach}, {&SourceOf(elbow), -kHandReach}});
    Note(hand, "beyond the wrist, away from the elbow");
  }

  void PlaceMissingToes() {
    if (!skeleton_.feet) return;
    for (const motion::Bone& bone : skeleton_.bones) {
      const bool toe = bone.parent == skeleton_.feet->left || bone.parent == skeleton_.feet->right;
      if (!toe || Found(bone.child) || !Found(bone.parent)) continue;
      found_[static_cast<size_t>(bone.child)] = SourceOf(bone.parent);
      Note(bone.child, "at the foot; the file has no toes");
    }
  }

  // Maps the joints that depend on positions, in `measured_`.
  void PlaceTrunk() {
    PlaceNeck();
    PlaceInTrunk("torso", "neck", 0.5f, "the spine joint nearest to half way from hips to neck",
                 "half way from hips to neck; no spine joint is near");
    constexpr char kNearest[] = "the spine joint nearest to its place";
    constexpr char kBetween[] = "between hips and neck; no spine joint is near";
    PlaceInTrunk("chest", "neck", kChestHeight, kNearest, kBetween);
    PlaceInTrunk("spine", "chest", kSpineHeight, kNearest, kBetween);
    PlaceInTrunk("hips", "neck", kHipsHeight, kNearest, kBetween);
    PlaceHeadTop();
    RaiseHead();
  }

  absl::StatusOr<JointMap> Finish() {
    std::vector<std::string> missing;
    JointMap map;
    Report();
    for (std::size_t joint = 0; joint < found_.size(); ++joint) {
      if (!found_[joint].has_value()) {
        missing.push_back(skeleton_.joint_names[joint]);
      } else {
        map.sources.push_back(*std::move(found_[joint]));
      }
    }
    if (missing.empty()) return map;
    return MendedBy(
        absl::InvalidArgumentError(absl::StrCat(
            source_, ": joints: expected joints for ", absl::StrJoin(missing, ", "), ", got none; ",
            ListNames(), "; specify a joint map such as ", missing[0], "=NAME")),
        motion::ReadingSetting::kJointMap);
  }

  void Report() const {
    if (readings_ == nullptr) return;
    readings_->clear();
    for (std::size_t joint = 0; joint < found_.size(); ++joint) {
      JointReading reading;
      reading.joint = skeleton_.joint_names[joint];
      reading.why = why_[joint];
      reading.origin = given_.count(static_cast<int>(joint)) > 0 ? Origin::kGiven
                       : reading.why.empty()                     ? Origin::kFile
                                                                 : Origin::kGuessed;
      if (found_[joint].has_value()) {
        for (const JointSource::Term& term : found_[joint]->terms) AddPart(term, &reading.parts);
      }
      readings_->push_back(std::move(reading));
    }
  }

  // Uses each joint of the file at most once.
  void AddPart(const JointSource::Term& term, std::vector<JointReading::Part>* parts) const {
    const std::string& name = names_[static_cast<size_t>(term.joint)];
    const auto known = std::find_if(parts->begin(), parts->end(),
                                    [&name](const auto& part) { return part.name == name; });
    if (known == parts->end()) {
      parts->push_back({name, term.weight});
    } else {
      known->weight += term.weight;
    }
  }

  bool Found(int joint) const {
    return joint >= 0 && found_[static_cast<size_t>(joint)].has_value();
  }
  JointSource& SourceOf(int joint) { return *found_[static_cast<size_t>(joint)]; }
  const std::string& TargetName(int joint) const {
    return skeleton_.joint_names[static_cast<size_t>(joint)];
  }
  // Neck and torso depend on positions: conventions differ in the number of spine joints.
  bool IsPlaced(int joint) const {
    return joint == skeleton_.Find("neck") || joint == skeleton_.Find("torso");
  }

  int FindExactly(absl::string_view name) const {
    const auto it = std::find(names_.begin(), names_.end(), name);
    return it == names_.end() ? -1 : static_cast<int>(it - names_.begin());
  }

  int FindUnused(const ParsedJointName& name) const {
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (!used_[i] && parsed_[i] == name) return static_cast<int>(i);
    }
    return -1;
  }

  void Take(int joint, int index) {
    used_[static_cast<size_t>(index)] = true;
    found_[static_cast<size_t>(joint)] = Whole(index);
  }

  std::string ListNames() const {
    const std::size_t shown = std::min(names_.size(), kMostNamesInError);
    const auto some = absl::MakeConstSpan(names_).first(shown);
    const auto append = [](std::string* out, const std::string& name) {
      absl::StrAppend(out, base::Printable(name, base::kLongestQuote));
    };
    return absl::StrCat("the file has ", absl::StrJoin(some, ", ", append),
                        shown < names_.size() ? ", ..." : "");
  }

  void MapByAlias(int joint) {
    const ParsedJointName target = ParseJointName(TargetName(joint));
    for (const std::string& alias : JointAliases(target.base)) {
      // A skeleton with both wrist and hand uses each for its own joint.
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

  // The only joint of the file that a skeleton's joint is mapped to, or -1.
  int FileJoint(absl::string_view target) const {
    const int joint = skeleton_.Find({target.data(), target.size()});
    return Found(joint) ? found_[static_cast<size_t>(joint)]->terms[0].joint : -1;
  }

  // Requires that neck and torso are not mapped yet: every source is one joint.
  Landmarks FindLandmarks() const {
    const auto pair = [this](absl::string_view left, absl::string_view right) {
      const motion::JointPair joints{FileJoint(left), FileJoint(right)};
      return joints.left < 0 || joints.right < 0 ? std::nullopt : std::make_optional(joints);
    };
    Landmarks landmarks;
    landmarks.head = FileJoint("head");
    landmarks.shoulders = pair("left_shoulder", "right_shoulder");
    if (skeleton_.hips) {
      landmarks.hips = pair(TargetName(skeleton_.hips->left), TargetName(skeleton_.hips->right));
    }
    return landmarks;
  }

  // The mean distance over the measured frames.
  float MeanDistance(const JointSource& a, const JointSource& b) const {
    double sum = 0;
    for (absl::Span<const motion::Vec3> pose : measured_) {
      sum += static_cast<double>(Distance(Evaluate(a, pose), Evaluate(b, pose)));
    }
    return static_cast<float>(sum / static_cast<double>(measured_.size()));
  }

  // The unused joint nearest to `place` and within `reach` of it for which `fits` holds, or -1.
  template <typename Fits>
  int FindNearest(const JointSource& place, float reach, Fits fits) const {
    int best = -1;
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (used_[i] || !fits(parsed_[i])) continue;
      const float distance = MeanDistance(Whole(static_cast<int>(i)), place);
      if (distance > reach) continue;
      best = static_cast<int>(i);
      reach = distance;
    }
    return best;
  }

  // Maps a joint to the unused one that FindNearest returns, or else to the place itself.
  template <typename Fits>
  void PlaceNear(int joint, const JointSource& place, float reach, Fits fits, const char* why_joint,
                 const char* why_place) {
    const int best = FindNearest(place, reach, fits);
    if (best >= 0) {
      Take(joint, best);
    } else {
      found_[static_cast<size_t>(joint)] = place;
    }
    Note(joint, best >= 0 ? why_joint : why_place);
  }

  void PlaceNeck() {
    const int neck = skeleton_.Find("neck");
    const int left = skeleton_.Find("left_shoulder"), right = skeleton_.Find("right_shoulder");
    if (neck < 0 || Found(neck)) return;
    if (!Found(left) || !Found(right)) return MapByAlias(neck);
    PlaceNear(neck, Mix({{&SourceOf(left), 0.5f}, {&SourceOf(right), 0.5f}}),
              MeanDistance(SourceOf(left), SourceOf(right)), IsNeck,
              "the neck joint nearest to half way between the shoulders",
              "half way between the shoulders; no neck joint is near");
  }

  // Places a joint of the trunk on the way from the middle of the hip joints to the joint `end`:
  // the nearest spine joint, or a point. Without a spine, a name must give it.
  void PlaceInTrunk(const char* target, const char* end, float height, const char* why_joint,
                    const char* why_place) {
    const int joint = skeleton_.Find(target), to = skeleton_.Find(end);
    if (joint < 0 || Found(joint)) return;
    if (!Found(to) || !HasSpineEnds()) return MapByAlias(joint);
    PlaceNear(joint,
              Mix({{&SourceOf(to), height},
                   {&SourceOf(skeleton_.hips->left), (1 - height) / 2},
                   {&SourceOf(skeleton_.hips->right), (1 - height) / 2}}),
              kTorsoReach * SpineLength(), IsSpine, why_joint, why_place);
  }

  // Above the head, in the direction from hips to neck, unless the file has an end of the head that
  // is not the head itself.
  void PlaceHeadTop() {
    const int top = skeleton_.Find("head_top"), head = skeleton_.Find("head");
    if (top < 0 || given_.count(top) > 0 || !Found(head) || !HasSpineEnds()) return;
    const float least = kShortestHead * SpineLength();
    if (Found(top) && MeanDistance(SourceOf(head), SourceOf(top)) >= least) return;
    found_[static_cast<size_t>(top)] = Mix({{&SourceOf(head), 1.0f},
                                            {&SourceOf(skeleton_.Find("neck")), kHeadTopRise},
                                            {&SourceOf(skeleton_.hips->left), -kHeadTopRise / 2},
                                            {&SourceOf(skeleton_.hips->right), -kHeadTopRise / 2}});
    Note(top, "above the head; the file has no end of the head");
  }

  // Capture software has the head joint at the base of the skull. The skeleton's is in the middle
  // of the head: half way to its end or, in a file without that end, along the neck.
  void RaiseHead() {
    const int head = skeleton_.Find("head"), neck = skeleton_.Find("neck");
    if (!Found(head) || given_.count(head) > 0 || !HasSpineEnds()) return;
    if (skeleton_.Find("head_top") >= 0) return;  // its head is the joint at the base of the skull
    const JointSource base = SourceOf(head);
    for (const char* end : {"headend", "headtopend", "headtop"}) {
      const int index = FindUnused({BodySide::kMiddle, end});
      if (index < 0) continue;
      const auto i = static_cast<size_t>(index);
      const JointSource top = Whole(index);
      if (MeanDistance(base, top) < kShortestHead * SpineLength()) continue;
      SourceOf(head) = Mix({{&base, 0.5f}, {&top, 0.5f}});
      return Note(head, absl::StrCat("half way from the head's joint to ", names_[i]));
    }
    const float way = MeanDistance(base, SourceOf(neck)) / SpineLength();
    if (!(way > kShortestNeck && way < kLongestNeck)) return;
    const float rise = kHeadRise / way;
    SourceOf(head) = Mix({{&base, 1 + rise}, {&SourceOf(neck), -rise}});
    Note(head, "raised from the base of the skull to its middle, away from the neck");
  }

  bool HasSpineEnds() const {
    return skeleton_.hips && Found(skeleton_.Find("neck")) && Found(skeleton_.hips->left) &&
           Found(skeleton_.hips->right);
  }

  // The distance from hips to neck. Requires HasSpineEnds.
  float SpineLength() {
    const JointSource hips =
        Mix({{&SourceOf(skeleton_.hips->left), 0.5f}, {&SourceOf(skeleton_.hips->right), 0.5f}});
    return MeanDistance(hips, SourceOf(skeleton_.Find("neck")));
  }

  // Explains the source of a joint of the skeleton.
  void Note(int joint, std::string why) { why_[static_cast<size_t>(joint)] = std::move(why); }

  absl::string_view source_;
  const std::vector<std::string>& names_;
  std::vector<ParsedJointName> parsed_;  // [names]
  const motion::Skeleton& skeleton_;
  std::vector<JointReading>* readings_;                   // may be null
  std::vector<bool> used_;                                // [names]
  std::vector<std::optional<JointSource>> found_;         // [skeleton joints]
  std::vector<absl::Span<const motion::Vec3>> measured_;  // poses in which distances are taken
  std::vector<std::string> why_;  // [skeleton joints] unless the name is sufficient
  std::set<int> given_;           // joints that the user names
};

}  // namespace

absl::StatusOr<JointMap> MapJoints(absl::string_view source, const JointTree& tree,
                                   const motion::Skeleton& skeleton,
                                   const JointOverrides& overrides,
                                   std::vector<JointReading>* readings, MissingToes missing_toes) {
  return Mapper(source, tree.names, skeleton, readings).Map(&tree, {}, overrides, missing_toes);
}

absl::StatusOr<JointMap> MapJoints(absl::string_view source, const std::vector<std::string>& names,
                                   const motion::Poses& poses, const motion::Skeleton& skeleton,
                                   const JointOverrides& overrides,
                                   std::vector<JointReading>* readings) {
  return Mapper(source, names, skeleton, readings)
      .Map(nullptr, poses, overrides, MissingToes::kRejected);
}

std::vector<motion::Vec3> ApplyJointMap(const JointMap& map, absl::Span<const motion::Vec3> pose) {
  std::vector<motion::Vec3> mapped;
  mapped.reserve(map.sources.size());
  for (const JointSource& source : map.sources) mapped.push_back(Evaluate(source, pose));
  return mapped;
}

absl::StatusOr<JointOverrides> ParseJointTable(absl::string_view text, absl::string_view source) {
  JointOverrides table;
  base::LineReader lines(base::SkipByteOrderMark(text));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line[0] == '#') continue;
    const std::pair<absl::string_view, absl::string_view> joints =
        absl::StrSplit(line, absl::MaxSplits('=', 1));
    const absl::string_view target = absl::StripAsciiWhitespace(joints.first);
    const absl::string_view name = absl::StripAsciiWhitespace(joints.second);
    if (target.empty() || name.empty()) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected MODEL_JOINT=FILE_JOINT such as left_hand=LeftWrist, "
                       "got ",
                       base::Quoted(line)));
    }
    if (!table.emplace(target, name).second) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected each joint once, got ", base::Quoted(target), " twice"));
    }
  }
  return table;
}

}  // namespace duet::retargeting
