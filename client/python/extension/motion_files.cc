#include "client/python/extension/motion_files.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/formats/people.h"
#include "model/formats/research/layout.h"
#include "model/motion/coordinates.h"
#include "model/motion/reading_setting.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/resample.h"
#include "model/motion/skeleton.h"
#include "model/motion/stated_unit.h"

namespace duet::client::python::extension {
namespace {

using Clips = std::vector<motion::Clip>;

// Sets `value` to the parsed text. INVALID_ARGUMENT for a text that is not one of `known`.
template <typename Value, typename Parse>
absl::Status Choose(absl::string_view field, const std::string& text, Parse parse,
                    absl::string_view known, std::optional<Value>* value) {
  if (text.empty()) return absl::OkStatus();
  *value = parse(text);
  if (value->has_value()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": expected ", known, ", got ", base::Quoted(text)));
}

std::optional<formats::Side> ParseSide(absl::string_view name) {
  if (name == "left") return formats::Side::kLeft;
  if (name == "right") return formats::Side::kRight;
  return std::nullopt;
}

absl::StatusOr<formats::ReadOptions> OptionsOf(const ReadArguments& arguments) {
  std::optional<motion::LengthUnit> unit;
  std::optional<motion::UpAxis> up_axis;
  absl::Status status =
      Choose("unit", arguments.unit, motion::ParseLengthUnit, motion::kLengthUnitNames, &unit);
  status.Update(
      Choose("up_axis", arguments.up_axis, motion::ParseUpAxis, motion::kUpAxisNames, &up_axis));
  formats::ReadOptions options;
  status.Update(Choose("layout", arguments.layout, formats::research::ParseLayout,
                       formats::research::kLayoutNames, &options.layout));
  if (!status.ok()) return status;
  options.body_model = arguments.body_model;
  options.coordinates = motion::StatedCoordinates(unit, up_axis);
  options.frame_rate_hz = arguments.frame_rate_hz;
  options.metres_per_unit = motion::StatedMetresPerUnit(arguments.metres_per_unit, unit);
  options.joint_overrides = arguments.joint_map;
  return options;
}

// Keeps the person at a side. A file of one person is valid for both sides.
absl::Status KeepSide(const std::string& side, Clips* people) {
  std::optional<formats::Side> kept;
  absl::Status status = Choose("side", side, ParseSide, "left or right", &kept);
  if (!status.ok() || !kept.has_value()) return status;
  if (*kept == formats::Side::kRight && people->size() > 1) std::swap((*people)[0], (*people)[1]);
  people->resize(1);
  return absl::OkStatus();
}

absl::StatusOr<formats::ReadPeople> ParseDocument(const std::string& document,
                                                  formats::ReadOptions options) {
  options.format = formats::Format::kJson;
  return formats::ReadAllPeople(
      [&document](const formats::ReadOptions& person) {
        return formats::ParseLeader(document, "motion", person);
      },
      options);
}

}  // namespace

absl::StatusOr<Clips> ReadMotion(const std::filesystem::path& file,
                                 const ReadArguments& arguments) {
  const absl::StatusOr<formats::ReadOptions> options = OptionsOf(arguments);
  if (!options.ok()) return options.status();
  absl::Status status = formats::CheckReadable(file, std::nullopt);
  if (!status.ok()) return status;
  absl::StatusOr<formats::ReadPeople> read = formats::ReadAllPeople(
      [&file](const formats::ReadOptions& person) { return formats::ReadLeader(file, person); },
      *options);
  if (!read.ok()) return read.status();
  status = KeepSide(arguments.side, &read->people);
  for (motion::Clip& person : read->people) {
    if (status.ok() && arguments.resample_hz) {
      status = motion::ResampleByRate("resample_hz", *arguments.resample_hz, &person);
    }
  }
  if (status.ok()) status = CheckPeople(read->people, options->skeleton);
  if (!status.ok()) return status;
  return std::move(read->people);
}

absl::Status WriteMotion(const std::string& document, const std::filesystem::path& file) {
  if (!formats::IsWritable(file)) {
    return formats::UnknownExtension(file, formats::kWritableExtensions);
  }
  absl::Status status = formats::CheckFolderOf(file);
  if (!status.ok()) return status;
  const formats::ReadOptions options;
  const absl::StatusOr<formats::ReadPeople> read = ParseDocument(document, options);
  if (!read.ok()) return read.status();
  return formats::WritePeople(file, *formats::FormatOf(file), read->people, options.skeleton)
      .status();
}

absl::StatusOr<motion::VerticalEstimate> EstimateVertical(
    const std::vector<std::string>& documents) {
  const formats::ReadOptions options;
  motion::VerticalEvidence evidence(options.skeleton);
  for (const std::string& document : documents) {
    const absl::StatusOr<formats::ReadPeople> read = ParseDocument(document, options);
    // Without the advice for readers of files: no argument helps here.
    if (!read.ok()) return absl::InvalidArgumentError(read.status().message());
    for (const motion::Clip& person : read->people) evidence.Add(person);
  }
  return evidence.Estimate();
}

std::string DescribeError(const absl::Status& error) {
  std::string text(error.message());
  const absl::string_view argument = motion::MendingField(error);
  if (!argument.empty()) absl::StrAppend(&text, "\nSpecify it with ", argument, ".");
  return text;
}

}  // namespace duet::client::python::extension
