#include "model/retargeting/body_roles.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/printable.h"
#include "model/base/text.h"
#include "model/retargeting/joint_names.h"

namespace duet::retargeting {
namespace {

constexpr std::size_t kMostNamesInError = 30;

class RoleFinder {
 public:
  RoleFinder(const motion::Clip& clip, const JointMap& body) : clip_(clip), body_(body) {}

  // Joints on both sides with one of these bases that the body does not use.
  std::optional<motion::JointPair> Find(std::initializer_list<const char*> bases) const {
    const int left = Find(BodySide::kLeft, bases), right = Find(BodySide::kRight, bases);
    if (left < 0 || right < 0) return std::nullopt;
    return motion::JointPair{left, right};
  }

 private:
  int Find(BodySide side, std::initializer_list<const char*> bases) const {
    for (const char* base : bases) {
      for (int joint = 0; joint < clip_.joint_count(); ++joint) {
        const std::string& name = clip_.joint_names[static_cast<std::size_t>(joint)];
        if (ParseJointName(name) == ParsedJointName{side, base} && !IsUsed(joint)) return joint;
      }
    }
    return -1;
  }

  bool IsUsed(int joint) const {
    return std::any_of(body_.sources.begin(), body_.sources.end(), [joint](const auto& source) {
      return source.terms.size() == 1 && source.terms[0].joint == joint;
    });
  }

  const motion::Clip& clip_;
  const JointMap& body_;
};

absl::Status NoPerson(absl::string_view field, const motion::Clip& clip) {
  const std::size_t shown = std::min(clip.joint_names.size(), kMostNamesInError);
  const auto append = [](std::string* out, const std::string& name) {
    absl::StrAppend(out, base::Printable(name, base::kLongestQuote));
  };
  return absl::InvalidArgumentError(absl::StrCat(
      field,
      ": joints: expected those of a person, named as in docs/formats.md, to write onto a rig; "
      "got ",
      absl::StrJoin(clip.joint_names.begin(),
                    clip.joint_names.begin() + static_cast<std::ptrdiff_t>(shown), ", ", append),
      shown < clip.joint_names.size() ? ", ..." : ""));
}

}  // namespace

absl::StatusOr<BodyRoles> FindBodyRoles(absl::string_view field, const motion::Clip& clip) {
  absl::StatusOr<JointMap> body =
      MapJoints(field, clip.joint_names, clip.poses, motion::SbuSkeleton());
  if (!body.ok()) return NoPerson(field, clip);
  BodyRoles roles;
  const RoleFinder finder(clip, *body);
  roles.toes = finder.Find({"toe", "toebase", "toes", "ball", "footend", "foot"});
  roles.hands = finder.Find({"hand", "handmiddle1", "middle1", "middle01"});
  roles.body = *std::move(body);
  return roles;
}

JointMap Compose(const JointMap& first, const JointMap& second) {
  JointMap composed;
  for (const JointSource& outer : second.sources) {
    JointSource source;
    for (const JointSource::Term& term : outer.terms) {
      for (const JointSource::Term& inner :
           first.sources[static_cast<std::size_t>(term.joint)].terms) {
        source.terms.push_back({inner.joint, inner.weight * term.weight});
      }
    }
    composed.sources.push_back(std::move(source));
  }
  return composed;
}

}  // namespace duet::retargeting
