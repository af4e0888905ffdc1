#include "tests/fuzz/motion_targets.h"

#include <map>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "model/dataset/layout.h"
#include "model/dataset/leader_side.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/motion_file.h"
#include "model/motion/motion_limits.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/joint_mapping.h"
#include "tests/fuzz/promises.h"
#include "tests/support/test_motion.h"

namespace duet::fuzz {
namespace {

using formats::Format;

constexpr char kSource[] = "input";
constexpr double kFrameRateHz = 30;
// Longer ones are read only.
constexpr int kMostFramesWritten = 16;

// What every caller takes for granted of a motion that was read.
Broken CheckRead(const motion::Clip& clip, const motion::Skeleton& skeleton) {
  if (clip.joint_names != skeleton.joint_names) return "a clip has other joints than were wanted";
  const absl::Status valid = motion::CheckClip("clip", clip);
  return valid.ok() ? "" : absl::StrCat("a clip was read that is none: ", valid.ToString());
}

// What was read can be written, or else is refused in words; what was written can be read.
Broken CheckWritten(const motion::Clip& clip, const motion::Skeleton& skeleton, Format format) {
  const absl::StatusOr<std::string> text = formats::FormatPeople(format, {clip}, skeleton);
  if (!text.ok()) return CheckRefusal(text.status());
  formats::ReadOptions options;
  options.format = format;
  // Of a body that is no human's size, nobody can tell the unit.
  if (format == Format::kBvh) options.metres_per_unit = formats::kCentimetre;
  const absl::StatusOr<motion::Clip> again = formats::ParseLeader(*text, kSource, options);
  if (!again.ok()) return CheckRefusal(again.status());
  return again->frame_count() == clip.frame_count() ? "" : "a written clip has other frames";
}

// Writing takes the time of many other inputs: a part of them is written, each of it in one format.
std::optional<Format> FormatToWrite(absl::string_view input) {
  switch (input.size() % 16) {
    case 0:
      return Format::kBvh;
    case 1:
      return Format::kCsv;
    case 2:
      return Format::kJson;
    default:
      return std::nullopt;
  }
}

Broken ReadMotion(Format format, absl::string_view input, std::optional<double> frame_rate_hz) {
  retargeting::ReadingReport report;
  formats::ReadOptions options;
  options.format = format;
  options.frame_rate_hz = frame_rate_hz;
  options.report = &report;
  for (const formats::Side side : {formats::Side::kLeft, formats::Side::kRight}) {
    options.side = side;
    const absl::StatusOr<motion::Clip> clip =
        formats::ParseLeader(std::string(input), kSource, options);
    if (!clip.ok()) return CheckRefusal(clip.status());
    Broken broken = CheckRead(*clip, options.skeleton);
    if (const std::optional<Format> written = FormatToWrite(input);
        broken.empty() && written.has_value() && clip->frame_count() <= kMostFramesWritten) {
      broken = CheckWritten(*clip, options.skeleton, *written);
    }
    if (!broken.empty()) return broken;
  }
  return "";
}

const motion::Clip& ShortPerson() {
  static const auto* const kPerson = [] {
    test::PersonOptions options;
    options.frames = 3;
    return new motion::Clip(test::MakePerson(options));
  }();
  return *kPerson;
}

}  // namespace

Broken Bvh(absl::string_view input) {
  Broken broken = ReadMotion(Format::kBvh, input, std::nullopt);
  const absl::StatusOr<formats::bvh::BvhDocument> rig = formats::bvh::ParseBvh(input, kSource);
  if (!broken.empty() || !rig.ok()) return broken;
  const absl::StatusOr<formats::bvh::BvhDocument> onto =
      formats::bvh::OntoBvhRig(ShortPerson(), *rig, kSource, {});
  if (!onto.ok()) return CheckRefusal(onto.status());
  const std::string text = FormatBvh(*onto);
  return CheckRefusal(formats::bvh::ParseBvh(text, kSource).status(), {});
}

Broken Csv(absl::string_view input) { return ReadMotion(Format::kCsv, input, kFrameRateHz); }

Broken JsonMotion(absl::string_view input) {
  return ReadMotion(Format::kJson, input, kFrameRateHz);
}

Broken Npy(absl::string_view input) { return ReadMotion(Format::kNpy, input, kFrameRateHz); }

Broken SbuText(absl::string_view input) {
  return ReadMotion(Format::kSbuText, input, std::nullopt);
}

Broken Gltf(absl::string_view input) {
  Broken broken = ReadMotion(Format::kGltf, input, std::nullopt);
  if (!broken.empty()) return broken;
  // Every file beside it is this one: buffers that a document names are read at least.
  const auto read_beside = [&input](const std::string&) -> absl::StatusOr<std::string> {
    return std::string(input);
  };
  const absl::StatusOr<std::string> onto = formats::gltf::OntoGltfRig(
      ShortPerson(), input, kSource, read_beside, {}, formats::gltf::GltfContainer::kBinary);
  if (!onto.ok()) return CheckRefusal(onto.status());
  return CheckRefusal(formats::gltf::ParseGltf(*onto, kSource).status(), {});
}

Broken JointMap(absl::string_view input) {
  return CheckRefusal(retargeting::ParseJointTable(input, kSource).status());
}

Broken DatasetLayout(absl::string_view input) {
  const absl::StatusOr<dataset::DatasetLayout> layout = dataset::ParseDatasetLayout(Std(input));
  if (!layout.ok()) return CheckRefusal(layout.status());
  const absl::Status valid = Validate(layout->skeleton);
  if (!valid.ok()) return absl::StrCat("a layout has no skeleton: ", valid.ToString());
  return layout->classes.empty() ? "a layout has no class" : "";
}

Broken DatasetIndex(absl::string_view input) {
  return CheckRefusal(dataset::ParseIndex(input).status());
}

}  // namespace duet::fuzz
