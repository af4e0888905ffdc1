#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/batch/text_values.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/motion_input.h"
#include "model/base/counted.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"
#include "model/retargeting/reading_report.h"

namespace duet::client::cli {
namespace {

using retargeting::JointReading;
using retargeting::Setting;

constexpr std::size_t kMaxNames = 12;

// What is known of one person of a file. If it cannot be read, `status` says why, and the report
// has what was understood up to there.
struct Inspection {
  std::string file;
  absl::Status status;
  retargeting::ReadingReport report;
  motion::Clip clip;  // at 0 Hz where no rate is known
};

// Empty if reading ended before this was known.
std::string DescribeSetting(const char* name, const std::optional<Setting>& setting) {
  if (!setting.has_value()) return "";
  std::string origin(OriginName(setting->origin));
  if (!setting->why.empty()) absl::StrAppend(&origin, ": ", base::EscapeControls(setting->why));
  return absl::StrFormat("  %-11s %s  (%s)\n", name, base::EscapeControls(setting->value), origin);
}

std::string DescribeJoints(const std::vector<JointReading>& joints) {
  std::string text = "  joints\n";
  for (const JointReading& joint : joints) {
    absl::StrAppendFormat(&text, "    %-15s ", joint.joint);
    if (joint.parts.empty()) {
      absl::StrAppend(&text, "missing", "\n");
      continue;
    }
    absl::StrAppend(&text, base::EscapeControls(DescribeParts(joint.parts)));
    const std::string why = joint.origin == retargeting::Origin::kGiven ? "given" : joint.why;
    if (!why.empty()) {
      absl::StrAppend(&text, "  (", base::EscapeControls(why), ")");
    }
    text += "\n";
  }
  return text;
}

// The first joints of the file that are not used.
std::string DescribeUnused(const retargeting::ReadingReport& report) {
  std::vector<std::string> unused;
  for (const std::string& name : report.file_joints) {
    const auto uses = [&name](const JointReading& joint) {
      return std::any_of(joint.parts.begin(), joint.parts.end(),
                         [&name](const JointReading::Part& part) { return part.name == name; });
    };
    if (std::none_of(report.joints.begin(), report.joints.end(), uses)) unused.push_back(name);
  }
  if (unused.empty() || report.joints.empty()) return "";
  const std::size_t more = unused.size() - std::min(unused.size(), kMaxNames);
  unused.resize(unused.size() - more);
  return absl::StrCat("    not used: ", base::EscapeControls(absl::StrJoin(unused, ", ")),
                      more > 0 ? absl::StrCat(" and ", more, " more") : "", "\n");
}

std::string DescribeReading(const retargeting::ReadingReport& report) {
  std::string text = absl::StrCat(DescribeSetting("frame rate", report.frame_rate),
                                  DescribeSetting("unit", report.unit),
                                  DescribeSetting("up axis", report.up_axis));
  for (const std::string& remark : report.remarks) {
    absl::StrAppend(&text, "  ", base::EscapeControls(remark), "\n");
  }
  if (!report.joints.empty()) absl::StrAppend(&text, DescribeJoints(report.joints));
  return text + DescribeUnused(report);
}

std::string DescribeLength(const motion::Clip& clip) {
  const int frames = clip.frame_count();
  std::string text = base::Counted(frames, "frame");
  if (clip.frame_rate_hz > 0) {
    absl::StrAppendFormat(&text, ", %.2f s at %g Hz", frames / clip.frame_rate_hz,
                          clip.frame_rate_hz);
  }
  return text;
}

std::string DescribeInspection(const Inspection& inspection) {
  std::string text = base::EscapeControls(inspection.file);
  const retargeting::ReadingReport& report = inspection.report;
  if (!report.format.empty()) absl::StrAppend(&text, ": ", report.format);
  if (report.people > 0) {
    absl::StrAppend(&text, ", ", base::Counted(report.people, "person", "people"));
  }
  const motion::Clip& clip = inspection.clip;
  if (clip.frame_count() > 0) absl::StrAppend(&text, ", ", DescribeLength(clip));
  text += "\n";
  if (clip.frame_count() > 0 && !report.frame_rate.has_value()) {
    absl::StrAppend(&text, "  frame rate  ", "unknown; specify it with --frame-rate HZ", "\n");
  }
  text += DescribeReading(report);
  if (!inspection.status.ok()) {
    absl::StrAppend(&text, "  ", "cannot be read", ": ", inspection.status.message(), "\n");
  }
  return text;
}

struct InspectArguments {
  std::vector<std::filesystem::path> files;
  formats::Side side = kDefaultSide;
  InputArguments input;
};

// Allows a motion without a frame rate. This rate is not reported.
constexpr double kStandInRateHz = 30;

// A file without a frame rate can be inspected too.
absl::StatusOr<motion::Clip> ReadAtAnyRate(const std::filesystem::path& file,
                                           formats::ReadOptions options) {
  absl::StatusOr<motion::Clip> clip = ReadMotion(file, options);
  if (motion::MendingSetting(clip.status()) != motion::ReadingSetting::kFrameRate) return clip;
  options.frame_rate_hz = kStandInRateHz;
  clip = ReadMotion(file, options);
  if (!clip.ok()) return clip;
  clip->frame_rate_hz = 0;
  options.report->frame_rate.reset();
  return clip;
}

Inspection Inspect(const std::filesystem::path& file, const InspectArguments& arguments) {
  Inspection inspection;
  inspection.file = file.string();
  inspection.status = formats::CheckReadable(file, arguments.input.format);
  if (!inspection.status.ok()) return inspection;
  absl::StatusOr<formats::ReadOptions> options =
      ToReadOptions(arguments.input, motion::SbuSkeleton());
  inspection.status = options.status();
  if (!inspection.status.ok()) return inspection;
  options->side = arguments.side;
  options->report = &inspection.report;
  absl::StatusOr<motion::Clip> clip = ReadAtAnyRate(file, *options);
  inspection.status = clip.status();
  if (clip.ok()) inspection.clip = *std::move(clip);
  return inspection;
}

ExitCode RunInspect(const InspectArguments& arguments, const ProgramEnvironment& environment) {
  ExitCode worst = kExitDone;
  for (std::size_t i = 0; i < arguments.files.size(); ++i) {
    const Inspection inspection = Inspect(arguments.files[i], arguments);
    worst = std::max(worst, ExitCodeFor(inspection.status));
    *environment.out << (i == 0 ? "" : "\n") << DescribeInspection(inspection)
                     << (inspection.status.ok() ? "" : DescribeAdvice(inspection.status));
  }
  return worst;
}

void AddFlags(CLI::App* command, InspectArguments* arguments) {
  command
      ->add_option("files", arguments->files,
                   absl::StrCat("Motions: ", formats::kReadableExtensions))
      ->required()
      ->type_name("FILE");
  AddParsed(command, kInputGroup, "--side", "left|right", batch::ParseSide, &arguments->side,
            "The person to read in a file with two people")
      ->default_str("left");
  AddInputFlags(command, &arguments->input);
}

}  // namespace

Command AddInspectCommand(CLI::App* program) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* app =
      program->add_subcommand("inspect", "Print what motion files contain and how Duet reads them");
  app->footer(R"(
Examples:
  duet inspect walk.bvh
  duet inspect captures/*.bvh
)");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunInspect);
}

}  // namespace duet::client::cli
