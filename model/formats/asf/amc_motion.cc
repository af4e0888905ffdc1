#include "model/formats/asf/amc_motion.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/angle.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::asf {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;
using Words = std::vector<absl::string_view>;

class AmcParser {
 public:
  AmcParser(absl::string_view text, absl::string_view source, const AsfSkeleton& skeleton)
      : lines_(base::SkipByteOrderMark(text)),
        source_(source),
        skeleton_(skeleton),
        radians_(skeleton.radians) {
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
      places_[skeleton.bones[b].name] = {b, width_};
      width_ += skeleton.bones[b].freedoms.size();
    }
  }

  absl::StatusOr<AmcMotion> Parse() {
    for (absl::string_view line; lines_.Next(&line);) {
      line = absl::StripAsciiWhitespace(line);
      if (line.empty() || line[0] == '#') continue;
      absl::Status status = ParseLine(line);
      if (!status.ok()) return status;
    }
    if (motion_.frame_count == 0)
      return Error("expected at least 1 frame, got none; is this an AMC file?");
    absl::Status status = CheckFrame();
    if (!status.ok()) return status;
    return std::move(motion_);
  }

 private:
  struct Place {
    std::size_t bone = 0;
    std::size_t start = 0;  // of its values in a frame
  };

  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, std::max(lines_.number(), 1), message);
  }

  absl::Status ParseLine(absl::string_view line) {
    if (line[0] == ':') {
      if (absl::EqualsIgnoreCase(line, ":degrees")) radians_ = false;
      if (absl::EqualsIgnoreCase(line, ":radians")) radians_ = true;
      return absl::OkStatus();
    }
    int number = 0;
    if (base::ParseInteger(line, &number)) return BeginFrame();
    return ParseBone(absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty()));
  }

  absl::Status BeginFrame() {
    if (motion_.frame_count > 0) {
      absl::Status status = CheckFrame();
      if (!status.ok()) return status;
    }
    if (motion_.frame_count == motion::kMaxMotionFrames) {
      return Error(
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    ++motion_.frame_count;
    motion_.values.resize(motion_.values.size() + width_);
    given_.assign(skeleton_.bones.size(), false);
    return absl::OkStatus();
  }

  // Checks that the open frame has values for every bone that moves.
  absl::Status CheckFrame() const {
    for (std::size_t b = 0; b < given_.size(); ++b) {
      if (given_[b] || skeleton_.bones[b].freedoms.empty()) continue;
      return Error(absl::StrCat("frame ", motion_.frame_count,
                                ", before this line: expected values for ",
                                base::Quoted(skeleton_.bones[b].name), ", got none"));
    }
    return absl::OkStatus();
  }

  absl::Status ParseBone(const Words& words) {
    const std::string name(words[0]);
    if (motion_.frame_count == 0) {
      return Error(absl::StrCat("expected a frame number, got ", base::Quoted(name)));
    }
    const auto found = places_.find(name);
    if (found == places_.end()) {
      return Error(absl::StrCat("expected a bone of the skeleton, got ", base::Quoted(name)));
    }
    const std::size_t bone = found->second.bone;
    const std::vector<AsfFreedom>& freedoms = skeleton_.bones[bone].freedoms;
    if (given_[bone]) {
      return Error(absl::StrCat(base::Quoted(name), ": expected once per frame, got twice"));
    }
    given_[bone] = true;
    if (words.size() - 1 != freedoms.size()) {
      return Error(absl::StrCat(base::Quoted(name), ": expected ", freedoms.size(), " values, got ",
                                words.size() - 1));
    }
    float* values = motion_.values.data() + motion_.values.size() - width_ + found->second.start;
    for (std::size_t i = 0; i < freedoms.size(); ++i) {
      if (!motion::ParseCoordinate(words[i + 1], &values[i])) {
        return Error(
            absl::StrCat(base::Quoted(name), ": ", motion::ExpectedCoordinate(words[i + 1])));
      }
      if (freedoms[i] >= AsfFreedom::kRx && !radians_)
        values[i] *= static_cast<float>(base::kRadiansPerDegree);
    }
    return absl::OkStatus();
  }

  base::LineReader lines_;
  absl::string_view source_;
  const AsfSkeleton& skeleton_;
  bool radians_;
  std::map<std::string, Place> places_;
  std::size_t width_ = 0;    // values in a frame
  std::vector<bool> given_;  // [bones], in the open frame
  AmcMotion motion_;
};

}  // namespace

absl::StatusOr<AmcMotion> ParseAmc(absl::string_view text, absl::string_view source,
                                   const AsfSkeleton& skeleton) {
  return AmcParser(text, source, skeleton).Parse();
}

AsfKinematics::AsfKinematics(const AsfSkeleton& skeleton, const AmcMotion& motion)
    : skeleton_(skeleton), motion_(motion) {
  std::vector<bool> has_child(skeleton.bones.size());
  for (const AsfBone& bone : skeleton.bones) {
    freedoms_ += bone.freedoms.size();
    if (bone.parent >= 0) has_child[static_cast<size_t>(bone.parent)] = true;
  }
  for (std::size_t b = 0; b < has_child.size(); ++b) {
    if (!has_child[b]) ends_.push_back(static_cast<int>(b));
  }
}

std::vector<Vec3d> AsfKinematics::Positions(int frame) const {
  const std::size_t count = skeleton_.bones.size();
  std::vector<Vec3d> starts(count), stops(count);
  std::vector<Quaternion> world(count);
  const float* values = motion_.values.data() + static_cast<std::size_t>(frame) * freedoms_;
  for (std::size_t b = 0; b < count; ++b) {
    const AsfBone& bone = skeleton_.bones[b];
    std::vector<AsfFreedom> axes;
    std::vector<double> angles;
    Vec3d moved;
    for (AsfFreedom freedom : bone.freedoms) {
      const double value = static_cast<double>(*values++);
      if (freedom == AsfFreedom::kTx) moved.x = value;
      if (freedom == AsfFreedom::kTy) moved.y = value;
      if (freedom == AsfFreedom::kTz) moved.z = value;
      if (freedom < AsfFreedom::kRx) continue;
      axes.push_back(freedom);
      angles.push_back(value);
    }
    const Quaternion local = bone.axes * TurnInOrder(axes, angles) * Inverse(bone.axes);
    const std::size_t parent = static_cast<std::size_t>(bone.parent);
    starts[b] = bone.parent < 0 ? skeleton_.position + moved : stops[parent];
    world[b] = bone.parent < 0 ? local : world[parent] * local;
    stops[b] = starts[b] + Rotate(world[b], bone.extent);
  }
  for (int end : ends_) starts.push_back(stops[static_cast<size_t>(end)]);
  return starts;
}

}  // namespace duet::formats::asf
