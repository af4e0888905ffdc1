#include "model/evaluation/report/pose_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/evaluation/report/pose_view.h"
#include "model/evaluation/report/svg.h"

namespace duet::evaluation::report {
namespace {

constexpr double kMargin = 18, kTitleRoom = 44, kNameRoom = 30, kTimeRoom = 30, kColumnGap = 22;
constexpr double kHoldSeconds = 0.5;
constexpr double kTitleSize = 16, kNameSize = 13;
// A strip is wide, so that pages shrink it.
constexpr double kStripTitleSize = 24, kStripNameSize = 20, kStripTimeSize = 18;

// Of the left, the middle and the right of a body.
struct Colours {
  const char *left, *middle, *right;
};
constexpr Colours kLeader = {"#7db3d8", "#0072B2", "#00588a"};
constexpr Colours kFollower = {"#f0a46a", "#D55E00", "#a84a00"};

std::string Stroke(const char* colour) {
  return absl::StrCat("fill=\"none\" stroke=\"", colour,
                      "\" stroke-width=\"5\" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
}
std::string Fill(const char* colour) { return absl::StrCat("fill=\"", colour, "\""); }

// One part of a body over time: a path for each frame.
struct Part {
  std::vector<std::string> frames;
  std::string style;
};

// The far side first, so that the near one covers it.
std::vector<Part> Parts(const motion::Skeleton& skeleton, const PoseView& view,
                        const motion::Poses& poses, const std::vector<int>& frames, Pixel offset,
                        const Colours& colours) {
  std::vector<Part> parts = {{{}, Stroke(colours.left)},
                             {{}, Stroke(colours.middle)},
                             {{}, Fill(colours.middle)},
                             {{}, Stroke(colours.right)}};
  for (const int frame : frames) {
    const BodyPaths body = DrawBody(skeleton, view, poses[frame], offset);
    parts[0].frames.push_back(body.left);
    parts[1].frames.push_back(body.middle);
    parts[2].frames.push_back(body.head);
    parts[3].frames.push_back(body.right);
  }
  return parts;
}

void DrawFloor(double left, double right, double y, SvgWriter* svg) {
  svg->Line(left, y, right, y, "stroke=\"#d0d0d0\" stroke-width=\"1\" fill=\"none\"");
}

void DrawPair(const motion::Skeleton& skeleton, const PoseView& view, const PicturedPair& pair,
              int frame, Pixel offset, SvgWriter* svg) {
  for (const auto& [poses, colours] :
       {std::pair{&pair.leader, kLeader}, std::pair{&pair.follower, kFollower}}) {
    for (const Part& part : Parts(skeleton, view, *poses, {frame}, offset, colours)) {
      if (!part.frames.front().empty()) svg->Path(part.frames.front(), part.style);
    }
  }
}

void AnimatePair(const motion::Skeleton& skeleton, const PoseView& view, const PicturedPair& pair,
                 double frame_rate_hz, Pixel offset, SvgWriter* svg) {
  std::vector<int> all;
  for (int t = 0; t < pair.leader.frame_count(); ++t) all.push_back(t);
  // Holds the last frame, so that the eye sees where it starts over.
  all.insert(all.end(), static_cast<size_t>(kHoldSeconds * frame_rate_hz), all.back());
  const double seconds = static_cast<double>(all.size()) / frame_rate_hz;
  for (const auto& [poses, colours] :
       {std::pair{&pair.leader, kLeader}, std::pair{&pair.follower, kFollower}}) {
    for (const Part& part : Parts(skeleton, view, *poses, all, offset, colours)) {
      const std::string& still = part.frames[part.frames.size() / 2];
      if (!still.empty()) svg->MovingPath(still, part.frames, seconds, part.style);
    }
  }
}

void DrawTitle(const std::string& title, double size, SvgWriter* svg) {
  svg->Text(kMargin, 26, title, TextAnchor::kStart, size, "font-weight=\"bold\"");
}

std::vector<int> Moments(int frames, int columns) {
  std::vector<int> moments;
  for (int i = 0; i < columns; ++i) {
    const double share = columns == 1 ? 0 : static_cast<double>(i) / (columns - 1);
    moments.push_back(static_cast<int>(std::lround(share * (frames - 1))));
  }
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
  return moments;
}

}  // namespace

std::string StripSvg(const motion::Skeleton& skeleton, const std::string& title,
                     const std::vector<PicturedPair>& pairs, double frame_rate_hz, int columns) {
  const PoseView view(skeleton, pairs);
  const std::vector<int> moments = Moments(pairs.front().leader.frame_count(), columns);
  const double column = view.width() + kColumnGap;
  const double width = 2 * kMargin + column * static_cast<double>(moments.size()) - kColumnGap;
  const double row = kNameRoom + view.height();
  const double rows_end = kTitleRoom + row * static_cast<double>(pairs.size());
  SvgWriter svg(width, rows_end + kTimeRoom);
  DrawTitle(title, kStripTitleSize, &svg);
  for (size_t r = 0; r < pairs.size(); ++r) {
    const double top = kTitleRoom + row * static_cast<double>(r);
    svg.Text(kMargin, top + 18, pairs[r].name, TextAnchor::kStart, kStripNameSize);
    DrawFloor(kMargin, width - kMargin, top + row - 4, &svg);
    for (size_t c = 0; c < moments.size(); ++c) {
      const Pixel offset = {kMargin + column * static_cast<double>(c), top + kNameRoom};
      DrawPair(skeleton, view, pairs[r], moments[c], offset, &svg);
    }
  }
  for (size_t c = 0; c < moments.size(); ++c) {
    svg.Text(kMargin + column * static_cast<double>(c) + view.width() / 2, rows_end + 18,
             absl::StrFormat("%.1f s", moments[c] / frame_rate_hz), TextAnchor::kMiddle,
             kStripTimeSize);
  }
  return svg.Finish();
}

std::string MovingSvg(const motion::Skeleton& skeleton, const std::string& title,
                      const std::vector<PicturedPair>& pairs, double frame_rate_hz) {
  const PoseView view(skeleton, pairs);
  const double panel = view.width() + kMargin;
  const double width = kMargin + panel * static_cast<double>(pairs.size());
  const double floor = kTitleRoom + kNameRoom + view.height();
  SvgWriter svg(width, floor + kMargin);
  DrawTitle(title, kTitleSize, &svg);
  for (size_t i = 0; i < pairs.size(); ++i) {
    const double left = kMargin + panel * static_cast<double>(i);
    svg.Text(left, kTitleRoom + 12, pairs[i].name, TextAnchor::kStart, kNameSize);
    DrawFloor(left, left + view.width(), floor - 4, &svg);
    AnimatePair(skeleton, view, pairs[i], frame_rate_hz, {left, kTitleRoom + kNameRoom}, &svg);
  }
  return svg.Finish();
}

}  // namespace duet::evaluation::report
