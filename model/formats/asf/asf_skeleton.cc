#include "model/formats/asf/asf_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/angle.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::asf {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;
using Words = std::vector<absl::string_view>;

constexpr char kRoot[] = "root";

std::optional<AsfFreedom> ParseFreedom(absl::string_view word) {
  constexpr absl::string_view kNames[] = {"tx", "ty", "tz", "rx", "ry", "rz"};
  const std::string lower = absl::AsciiStrToLower(word);
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (lower == kNames[i]) return static_cast<AsfFreedom>(i);
  }
  return std::nullopt;
}

bool IsTurn(AsfFreedom freedom) { return freedom >= AsfFreedom::kRx; }

class AsfParser {
 public:
  AsfParser(absl::string_view text, absl::string_view source)
      : lines_(base::SkipByteOrderMark(text)), source_(source) {
    skeleton_.bones.emplace_back();
    skeleton_.bones[0].name = kRoot;
  }

  absl::StatusOr<AsfSkeleton> Parse() {
    for (absl::string_view line; lines_.Next(&line);) {
      line = absl::StripAsciiWhitespace(line);
      if (line.empty() || line[0] == '#') continue;
      const Words words = absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
      absl::Status status = ParseLine(words);
      if (!status.ok()) return status;
    }
    if (in_block_) return Error("expected end, got the end of the file");
    if (skeleton_.bones.size() < 2)
      return Error(":bonedata: expected at least 1 bone, got none; is this an ASF file?");
    absl::Status status = SortBones();
    if (!status.ok()) return status;
    return std::move(skeleton_);
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, std::max(lines_.number(), 1), message);
  }
  absl::Status Unexpected(absl::string_view what, const Words& words,
                          absl::string_view expected) const {
    return Error(absl::StrCat(what, ": expected ", expected, ", got ",
                              base::Quoted(absl::StrJoin(words, " "))));
  }

  absl::Status ParseLine(const Words& words) {
    if (words[0][0] == ':') {
      if (in_block_) return Unexpected(section_, words, "end");
      section_ = absl::AsciiStrToLower(words[0]);
      return absl::OkStatus();
    }
    if (section_ == ":units") return ParseUnit(words);
    if (section_ == ":root") return ParseRoot(words);
    if (section_ == ":bonedata") return ParseBone(words);
    if (section_ == ":hierarchy") return ParseHierarchy(words);
    return absl::OkStatus();  // version, name, documentation, skin
  }

  absl::Status ParseUnit(const Words& words) {
    if (words[0] == "length") return ParseLengthUnit(words);
    if (words[0] == "angle") return ParseAngleUnit(words);
    return absl::OkStatus();
  }

  absl::Status ParseLengthUnit(const Words& words) {
    float units = 0;
    if (words.size() != 2 || !motion::ParseCoordinate(words[1], &units) || !(units > 0)) {
      return Unexpected("length", words, "a number above 0");
    }
    skeleton_.units_per_inch = static_cast<double>(units);
    return absl::OkStatus();
  }

  absl::Status ParseAngleUnit(const Words& words) {
    if (words.size() == 2 && (words[1] == "deg" || words[1] == "rad")) {
      skeleton_.radians = words[1] == "rad";
      return absl::OkStatus();
    }
    return Unexpected("angle", words, "angle deg or angle rad");
  }

  // Parses the words after the first as three numbers. Requires `more` words after them.
  absl::Status ParseVector(const Words& words, std::size_t more, Vec3d* vector) const {
    float values[3] = {};
    bool good = words.size() == 4 + more;
    for (std::size_t i = 0; i < 3 && good; ++i) {
      good = motion::ParseCoordinate(words[i + 1], &values[i]);
    }
    if (!good) return Unexpected(words[0], words, "three numbers");
    *vector = {values[0], values[1], values[2]};
    return absl::OkStatus();
  }

  // Parses "XYZ". The rotations apply in the order of the letters.
  absl::Status ParseOrder(const Words& words, absl::string_view order,
                          std::vector<AsfFreedom>* axes) const {
    axes->clear();
    for (char letter : order) {
      const std::optional<AsfFreedom> axis =
          ParseFreedom(absl::StrCat("r", std::string(1, letter)));
      if (!axis.has_value() || axes->size() == 3) {
        return Unexpected(words[0], words, "an order of axes such as XYZ");
      }
      axes->push_back(*axis);
    }
    return absl::OkStatus();
  }

  Quaternion Axes(const std::vector<AsfFreedom>& order, Vec3d angles) const {
    const double unit = skeleton_.radians ? 1 : base::kRadiansPerDegree;
    std::vector<double> in_order;
    for (AsfFreedom axis : order) {
      in_order.push_back(unit * (axis == AsfFreedom::kRx   ? angles.x
                                 : axis == AsfFreedom::kRy ? angles.y
                                                           : angles.z));
    }
    return TurnInOrder(order, in_order);
  }

  absl::Status ParseFreedoms(const Words& words, bool root, AsfBone* bone) const {
    bone->freedoms.clear();
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::optional<AsfFreedom> freedom = ParseFreedom(words[i]);
      const bool twice = freedom.has_value() &&
                         std::count(bone->freedoms.begin(), bone->freedoms.end(), *freedom) > 0;
      if (!freedom.has_value() || twice || (!root && !IsTurn(*freedom))) {
        return Unexpected(
            words[0], words,
            root ? "TX TY TZ RX RY RZ, each at most once" : "rx ry rz, each at most once");
      }
      bone->freedoms.push_back(*freedom);
    }
    return absl::OkStatus();
  }

  absl::Status ParseRoot(const Words& words) {
    AsfBone& root = skeleton_.bones[0];
    if (words[0] == "order") return ParseFreedoms(words, /*root=*/true, &root);
    absl::Status status;
    if (words[0] == "axis") {
      status = ParseOrder(words, words.size() == 2 ? words[1] : "?", &root_order_);
    }
    if (words[0] == "orientation") status = ParseVector(words, 0, &orientation_);
    if (words[0] == "position") status = ParseVector(words, 0, &skeleton_.position);
    if (status.ok()) root.axes = Axes(root_order_, orientation_);
    return status;
  }

  absl::Status ParseBone(const Words& words) {
    if (words[0] == "begin" && !in_block_) return BeginBone();
    if (!in_block_) return Unexpected("bone data", words, "begin");
    if (words[0] == "end") return EndBone();
    if (words[0] == "name") {
      if (words.size() != 2) return Unexpected("name", words, "one word");
      bone_.name = std::string(words[1]);
    } else if (words[0] == "direction") {
      return ParseVector(words, 0, &direction_);
    } else if (words[0] == "length") {
      float length = 0;
      if (words.size() != 2 || !motion::ParseCoordinate(words[1], &length)) {
        return Unexpected("length", words, "a number");
      }
      length_ = static_cast<double>(length);
    } else if (words[0] == "axis") {
      Vec3d angles;
      std::vector<AsfFreedom> order;
      absl::Status status = ParseVector(words, 1, &angles);
      if (status.ok()) status = ParseOrder(words, words[4], &order);
      if (status.ok()) bone_.axes = Axes(order, angles);
      return status;
    } else if (words[0] == "dof") {
      return ParseFreedoms(words, /*root=*/false, &bone_);
    }
    return absl::OkStatus();  // id, limits, masses
  }

  absl::Status BeginBone() {
    in_block_ = true;
    bone_ = {};
    direction_ = {};
    length_ = 0;
    return absl::OkStatus();
  }

  absl::Status EndBone() {
    in_block_ = false;
    if (bone_.name.empty()) return Error("name: expected a word, got none");
    if (skeleton_.Find(bone_.name) >= 0) {
      return Error(
          absl::StrCat("name: expected a new bone, got ", base::Quoted(bone_.name), " again"));
    }
    if (skeleton_.bones.size() >= motion::kMaxFileJoints) {
      return Error(absl::StrCat("expected at most ", motion::kMaxFileJoints, " bones, got more"));
    }
    bone_.extent = retargeting::Unit(direction_, {}) * length_;
    skeleton_.bones.push_back(std::move(bone_));
    return absl::OkStatus();
  }

  // Parses a line with a parent and its children.
  absl::Status ParseHierarchy(const Words& words) {
    if (words.size() == 1 && (words[0] == "begin" || words[0] == "end")) {
      in_block_ = words[0] == "begin";
      return absl::OkStatus();
    }
    if (words.size() < 2) return Unexpected("hierarchy", words, "a bone and its children");
    std::vector<int> bones;
    for (absl::string_view word : words) {
      bones.push_back(skeleton_.Find(word));
      if (bones.back() < 0) {
        return Error(absl::StrCat("hierarchy: expected a bone, got ", base::Quoted(word)));
      }
    }
    for (std::size_t i = 1; i < bones.size(); ++i) {
      AsfBone& child = skeleton_.bones[static_cast<size_t>(bones[i])];
      if (bones[i] == 0 || child.parent >= 0) {
        return Error(absl::StrCat("hierarchy: expected one parent for ", base::Quoted(words[i]),
                                  ", got two"));
      }
      child.parent = bones[0];
    }
    return absl::OkStatus();
  }

  // Sorts parents first. Fails if a bone is not below the root.
  absl::Status SortBones() {
    std::vector<int> order = {0};
    std::map<int, std::vector<int>> children;
    for (std::size_t b = 1; b < skeleton_.bones.size(); ++b) {
      children[skeleton_.bones[b].parent].push_back(static_cast<int>(b));
    }
    for (std::size_t next = 0; next < order.size(); ++next) {
      const std::vector<int>& below = children[order[next]];
      order.insert(order.end(), below.begin(), below.end());
    }
    if (order.size() != skeleton_.bones.size()) {
      return absl::InvalidArgumentError(
          absl::StrCat(source_, ": hierarchy: expected all ", skeleton_.bones.size() - 1,
                       " bones below the root, got ", order.size() - 1));
    }
    std::vector<int> places(order.size());
    std::vector<AsfBone> sorted;
    for (std::size_t i = 0; i < order.size(); ++i)
      places[static_cast<size_t>(order[i])] = static_cast<int>(i);
    for (int b : order) {
      sorted.push_back(std::move(skeleton_.bones[static_cast<size_t>(b)]));
      if (b > 0) sorted.back().parent = places[static_cast<size_t>(sorted.back().parent)];
    }
    skeleton_.bones = std::move(sorted);
    return absl::OkStatus();
  }

  base::LineReader lines_;
  absl::string_view source_;
  AsfSkeleton skeleton_;
  std::string section_;
  bool in_block_ = false;
  // The state of the root.
  std::vector<AsfFreedom> root_order_ = {AsfFreedom::kRx, AsfFreedom::kRy, AsfFreedom::kRz};
  Vec3d orientation_;
  // The state of the open bone.
  AsfBone bone_;
  Vec3d direction_;
  double length_ = 0;
};

}  // namespace

int AsfSkeleton::Find(absl::string_view name) const {
  const auto it = std::find_if(bones.begin(), bones.end(),
                               [name](const AsfBone& bone) { return bone.name == name; });
  return it == bones.end() ? -1 : static_cast<int>(it - bones.begin());
}

absl::StatusOr<AsfSkeleton> ParseAsf(absl::string_view text, absl::string_view source) {
  return AsfParser(text, source).Parse();
}

Quaternion TurnInOrder(const std::vector<AsfFreedom>& axes, const std::vector<double>& angles) {
  Quaternion turn;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Vec3d axis = axes[i] == AsfFreedom::kRx   ? Vec3d{1, 0, 0}
                       : axes[i] == AsfFreedom::kRy ? Vec3d{0, 1, 0}
                                                    : Vec3d{0, 0, 1};
    turn = retargeting::AxisAngle(axis, angles[i]) * turn;
  }
  return turn;
}

}  // namespace duet::formats::asf
