#include "model/evaluation/report/pose_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/evaluation/report/svg.h"

namespace duet::evaluation::report {
namespace {

constexpr double kPixelsAMetre = 78;
// How much of the depth shows: people behind each other are told apart.
constexpr double kDepthAcross = 0.18, kDepthUp = 0.14;
constexpr double kHeadMetres = 0.1, kMarginMetres = 0.16;

std::string Point(Pixel p) {
  const auto rounded = [](double value) { return std::round(value * 10) / 10; };
  return absl::StrCat(SvgNumber(rounded(p.x)), " ", SvgNumber(rounded(p.y)));
}

bool IsHead(const motion::Skeleton& skeleton, int joint) {
  return skeleton.joint_names[static_cast<size_t>(joint)] == "head";
}

std::string Circle(Pixel middle, double radius) {
  const std::string r = SvgNumber(radius), d = SvgNumber(2 * radius);
  return absl::StrCat("M", Point({middle.x - radius, middle.y}), "a", r, " ", r, " 0 1 0 ", d,
                      " 0a", r, " ", r, " 0 1 0 -", d, " 0z");
}

}  // namespace

PoseView::PoseView(const motion::Skeleton& skeleton, const std::vector<PicturedPair>& pairs) {
  const PicturedPair& first = pairs.front();
  motion::Vec3 line = first.follower.at(0, skeleton.root) - first.leader.at(0, skeleton.root);
  line.y = 0;
  across_ = Norm(line) == 0 ? motion::Vec3{1, 0, 0} : line / Norm(line);
  away_ = Cross({0, 1, 0}, across_);
  Pixel low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Pixel high = {-low.x, -low.y};
  for (const PicturedPair& pair : pairs) {
    for (const motion::Poses* poses : {&pair.leader, &pair.follower}) {
      for (const motion::Vec3 position : poses->all()) {
        const Pixel p = Project(position);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
  }
  const double margin = kMarginMetres * kPixelsAMetre;
  corner_ = {low.x - margin, low.y - margin};
  width_ = high.x - low.x + 2 * margin;
  height_ = high.y - low.y + 2 * margin;
}

Pixel PoseView::Project(motion::Vec3 world) const {
  const double depth = Dot(world, away_);
  return {kPixelsAMetre * (Dot(world, across_) + kDepthAcross * depth),
          -kPixelsAMetre * (world.y + kDepthUp * depth)};
}

Pixel PoseView::At(motion::Vec3 world) const {
  const Pixel p = Project(world);
  return {p.x - corner_.x, p.y - corner_.y};
}

BodyPaths DrawBody(const motion::Skeleton& skeleton, const PoseView& view,
                   absl::Span<const motion::Vec3> pose, Pixel offset) {
  const auto at = [&](int joint) {
    const Pixel p = view.At(pose[static_cast<size_t>(joint)]);
    return Pixel{p.x + offset.x, p.y + offset.y};
  };
  BodyPaths paths;
  for (const motion::Bone& bone : skeleton.bones) {
    const std::string& name = skeleton.joint_names[static_cast<size_t>(bone.child)];
    if (IsHead(skeleton, bone.child))
      paths.head += Circle(at(bone.child), kHeadMetres * kPixelsAMetre);
    std::string* side = &paths.middle;
    if (absl::StrContains(name, "left")) side = &paths.left;
    if (absl::StrContains(name, "right")) side = &paths.right;
    absl::StrAppend(side, "M", Point(at(bone.parent)), "L", Point(at(bone.child)));
  }
  return paths;
}

}  // namespace duet::evaluation::report
