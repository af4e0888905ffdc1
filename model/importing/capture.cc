#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/median.h"
#include "model/formats/motion_file.h"
#include "model/importing/steps.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/resample.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;

constexpr int kFewestFrames = 2;
// Median distance of the roots, metres.
constexpr double kNearest = 0.05, kFarthest = 10;
// One person's legs may be this factor shorter or longer than the range that InferUnit accepts for
// the median of all people.
constexpr double kLegTolerance = 1.5;

bool HasHierarchy(formats::Format format) {
  return format == formats::Format::kBvh || format == formats::Format::kGltf ||
         format == formats::Format::kGlb;
}

absl::StatusOr<motion::Clip> ReadPerson(const fs::path& path, formats::Side side,
                                        const CaptureOptions& options) {
  formats::ReadOptions read;
  read.side = side;
  read.skeleton = options.skeleton;
  read.joint_overrides = options.joint_overrides;
  read.frame_rate_hz = options.frame_rate_hz;
  retargeting::ReadingReport report;
  read.report = &report;
  const std::optional<formats::Format> format = formats::FormatOf(path);
  if (format.has_value() && HasHierarchy(*format)) {
    read.metres_per_unit = 1;
    read.coordinates = motion::Coordinates{};
  }
  absl::StatusOr<motion::Clip> person = formats::ReadLeader(path, read);
  if (person.ok() && options.notes != nullptr) {
    for (std::string& note : report.Notes()) options.notes->push_back(std::move(note));
  }
  if (person.ok() || format != formats::Format::kNpy) return person;
  return absl::Status(
      person.status().code(),
      absl::StrCat(person.status().message(),
                   "; NPY states neither frame rate nor joints: specify --frame-rate, and "
                   "--skeleton unless they are the 15 joints of SBU"));
}

// Resamples the whole duration, as the engine does with leaders.
void ToRate(double rate_hz, motion::Clip* clip) {
  if (clip->frame_rate_hz != rate_hz) {
    clip->poses = Resample(clip->poses, clip->frame_rate_hz, rate_hz);
  }
  clip->frame_rate_hz = rate_hz;
}

double MedianRootDistance(const Capture& capture, int root) {
  std::vector<double> distances;
  for (int t = 0; t < capture.first.frame_count(); ++t) {
    distances.push_back(Distance(capture.first.at(t, root), capture.second.at(t, root)));
  }
  return base::Median(std::move(distances));
}

motion::Clip Piece(const motion::Clip& whole, int first, int frames) {
  motion::Clip piece;
  piece.joint_names = whole.joint_names;
  piece.frame_rate_hz = whole.frame_rate_hz;
  piece.Append(whole.poses.frames(first, frames));
  return piece;
}

}  // namespace

absl::StatusOr<Capture> ReadCapture(const fs::path& folder, const PairFiles& files,
                                    const CaptureOptions& options) {
  const bool one_file = files.first == files.second;
  absl::StatusOr<motion::Clip> first =
      ReadPerson(folder / files.first, formats::Side::kLeft, options);
  if (!first.ok()) return first.status();
  absl::StatusOr<motion::Clip> second = ReadPerson(
      folder / files.second, one_file ? formats::Side::kRight : formats::Side::kLeft, options);
  if (!second.ok()) return second.status();
  // The reader returns the only person of a file for either side.
  if (first->poses == second->poses) {
    return absl::InvalidArgumentError(
        one_file
            ? "people: expected 2 in the file, or a file for each whose names end in _a and _b "
              "(or _leader and _follower), got 1"
            : "expected one motion for each person, got the same one in both files");
  }
  const int frames = std::min(first->frame_count(), second->frame_count());
  if (frames < kFewestFrames) {
    return absl::InvalidArgumentError(
        absl::StrCat("frames: expected at least ", kFewestFrames, ", got ", frames));
  }
  return Capture{files, *std::move(first), *std::move(second)};
}

double Align(double rate_hz, Capture* capture) {
  ToRate(rate_hz, &capture->first);
  ToRate(rate_hz, &capture->second);
  const int first = capture->first.frame_count(), second = capture->second.frame_count();
  capture->first.poses.Resize(std::min(first, second));
  capture->second.poses.Resize(std::min(first, second));
  return std::abs(first - second) / rate_hz;
}

absl::Status CheckPlausible(const Capture& capture, const motion::Skeleton& skeleton) {
  for (const motion::Clip* person : {&capture.first, &capture.second}) {
    const double leg = motion::LegLength(skeleton, person->poses);
    const double shortest = motion::kShortestLeg / kLegTolerance;
    const double longest = motion::kLongestLeg * kLegTolerance;
    if (leg > shortest && leg < longest) continue;
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: legs: expected %.2g to %.2g m in the unit of the other files, got %.3g m",
        person == &capture.first ? capture.files.first : capture.files.second, shortest, longest,
        leg));
  }
  const double apart = MedianRootDistance(capture, skeleton.root);
  if (apart >= kNearest && apart <= kFarthest) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "distance of the two people: expected %g to %g m, got %.3g m; both must be in one world",
      kNearest, kFarthest, apart));
}

std::vector<Capture> Cut(const Capture& capture, int longest) {
  const int frames = capture.first.frame_count();
  const int pieces = (frames + longest - 1) / longest;
  if (pieces <= 1) return {capture};
  std::vector<Capture> cut;
  for (int i = 0; i < pieces; ++i) {
    const int first = frames * i / pieces, count = frames * (i + 1) / pieces - first;
    Capture piece = {capture.files, Piece(capture.first, first, count),
                     Piece(capture.second, first, count)};
    absl::StrAppend(&piece.files.name, "_p", i + 1);
    cut.push_back(std::move(piece));
  }
  return cut;
}

}  // namespace duet::importing
