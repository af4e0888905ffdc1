#include "client/batch/pose_strip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"

namespace duet::client::batch {
namespace {

constexpr int kMoments = 6;
// In the strip's unit, which is small enough for integer coordinates.
constexpr int kPlace = 1000;  // width of a moment, height of the strip
constexpr int kFloor = 950;
constexpr float kRoomAcross = 780, kRoomUp = 880;
constexpr float kHeadMetres = 0.1f;  // the radius of a head

// The projection of the pair.
struct View {
  motion::Vec3 across = {1, 0, 0};  // to the right of the picture
  float floor = 0;                  // metres
  float scale = 1;                  // of a metre
};

std::vector<int> Moments(int frame_count) {
  const int count = std::min(kMoments, frame_count);
  std::vector<int> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(count == 1 ? 0 : i * (frame_count - 1) / (count - 1));
  }
  return frames;
}

// The mean horizontal direction from leader to follower; x if they are at the same place.
motion::Vec3 Across(const motion::ClipPair& pair, int root) {
  motion::Vec3 sum;
  for (int t = 0; t < pair.leader.frame_count(); ++t) {
    sum = sum + (pair.follower.at(t, root) - pair.leader.at(t, root));
  }
  sum.y = 0;
  const float length = std::sqrt(Dot(sum, sum));
  return length > 0 ? sum / length : motion::Vec3{1, 0, 0};
}

// The mean horizontal position of the two people in the picture.
float Middle(const motion::ClipPair& pair, int root, int frame, motion::Vec3 across) {
  return Dot(pair.leader.at(frame, root) + pair.follower.at(frame, root), across) / 2;
}

View Look(const motion::ClipPair& pair, int root, const std::vector<int>& frames) {
  View view;
  view.across = Across(pair, root);
  float low = pair.leader.at(0, 0).y, high = low, reach = 0;
  for (const int frame : frames) {
    const float middle = Middle(pair, root, frame, view.across);
    for (const motion::Clip* person : {&pair.leader, &pair.follower}) {
      for (const motion::Vec3& point : person->poses[frame]) {
        low = std::min(low, point.y);
        high = std::max(high, point.y);
        reach = std::max(reach, std::abs(Dot(point, view.across) - middle));
      }
    }
  }
  view.floor = low;
  constexpr float kLeast = 0.1f;  // metres, for a body of one point
  view.scale = std::min(kRoomAcross / std::max(2 * reach, kLeast),
                        kRoomUp / std::max(high + kHeadMetres - low, kLeast));
  return view;
}

// The bones of one person at all moments, as the attribute d of an SVG path.
class PersonPath {
 public:
  PersonPath(const motion::Skeleton& skeleton, const View& view)
      : skeleton_(skeleton), head_(skeleton.Find("head")), view_(view) {}

  void Add(const motion::Clip& clip, int frame, int place, float middle) {
    const auto x = [&](int joint) {
      const float across = Dot(clip.at(frame, joint), view_.across) - middle;
      return static_cast<int>(std::lround(across * view_.scale)) + place * kPlace + kPlace / 2;
    };
    const auto y = [&](int joint) {
      const float up = clip.at(frame, joint).y - view_.floor;
      return kFloor - static_cast<int>(std::lround(up * view_.scale));
    };
    for (const motion::Bone& bone : skeleton_.bones) {
      absl::StrAppend(&d_, "M", x(bone.parent), " ", y(bone.parent), "L", x(bone.child), " ",
                      y(bone.child));
    }
    if (head_ < 0) return;
    const int radius = static_cast<int>(std::lround(kHeadMetres * view_.scale));
    // A circle as two arcs.
    absl::StrAppend(&d_, "M", x(head_) - radius, " ", y(head_), "a", radius, " ", radius, " 0 1 0 ",
                    2 * radius, " 0a", radius, " ", radius, " 0 1 0 ", -2 * radius, " 0");
  }
  const std::string& d() const { return d_; }

 private:
  const motion::Skeleton& skeleton_;
  int head_;
  View view_;
  std::string d_;
};

// A floor for each moment, with a gap to the next.
std::string Floors(size_t moments) {
  constexpr int kGap = 100;
  std::string d;
  for (size_t i = 0; i < moments; ++i) {
    absl::StrAppend(&d, "M", static_cast<int>(i) * kPlace + kGap / 2, " ", kFloor, "h",
                    kPlace - kGap);
  }
  return d;
}

}  // namespace

std::string PoseStrip(const motion::ClipPair& pair, const motion::Skeleton& skeleton) {
  const std::vector<int> frames = Moments(pair.leader.frame_count());
  const View view = Look(pair, skeleton.root, frames);
  PersonPath leader(skeleton, view), follower(skeleton, view);
  for (size_t i = 0; i < frames.size(); ++i) {
    const float middle = Middle(pair, skeleton.root, frames[i], view.across);
    leader.Add(pair.leader, frames[i], static_cast<int>(i), middle);
    follower.Add(pair.follower, frames[i], static_cast<int>(i), middle);
  }
  return absl::StrCat("<svg viewBox=\"0 0 ", kMoments * kPlace, " ", kPlace,
                      "\"><path class=\"floor\" d=\"", Floors(frames.size()),
                      "\"/><path class=\"leader\" d=\"", leader.d(),
                      "\"/><path class=\"follower\" d=\"", follower.d(), "\"/></svg>");
}

}  // namespace duet::client::batch
