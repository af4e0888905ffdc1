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
#include "client/cli/command.h"
#include "client/cli/motion_input.h"
#include "model/base/counted.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"
#include "model/retargeting/reading_report.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;
using retargeting::JointReading;
using retargeting::Setting;

constexpr std::size_t kMaxNames = 12;

// One person of a file.
struct InspectedPerson {
  retargeting::ReadingReport report;
  motion::Clip clip;  // at 0 Hz where no rate is known
};

// What is known of a file. If it cannot be read, `status` says why, and the one person has what was
// understood up to there.
struct Inspection {
  std::string file;
  absl::Status status;
  std::vector<InspectedPerson> people;
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

// Empty if both people have the same number of frames.
std::string DescribeUnlikeLength(const motion::Clip& first, const motion::Clip& second) {
  if (second.frame_count() == 0 || (second.frame_count() == first.frame_count() &&
                                    second.frame_rate_hz == first.frame_rate_hz)) {
    return "";
  }
  return absl::StrCat("  length      ", DescribeLength(second), "  ",
                      "unlike the other: each can be read alone, not both", "\n");
}

json SettingJson(const std::optional<Setting>& setting) {
  if (!setting.has_value()) return nullptr;
  json object = {{"value", setting->value}, {"origin", std::string(OriginName(setting->origin))}};
  if (!setting->why.empty()) object["why"] = setting->why;
  return object;
}

json JointJson(const JointReading& joint) {
  json parts = json::array();
  for (const JointReading::Part& part : joint.parts) {
    parts.push_back({{"joint", part.name}, {"weight", part.weight}});
  }
  json object = {{"joint", joint.joint},
                 {"parts", parts},
                 {"origin", parts.empty() ? "missing" : std::string(OriginName(joint.origin))}};
  if (!joint.why.empty()) object["why"] = joint.why;
  return object;
}

json PersonJson(const InspectedPerson& person) {
  json joints = json::array(), missing = json::array();
  for (const JointReading& joint : person.report.joints) {
    joints.push_back(JointJson(joint));
    if (joint.parts.empty()) missing.push_back(joint.joint);
  }
  return {{"frame_rate", SettingJson(person.report.frame_rate)},
          {"unit", SettingJson(person.report.unit)},
          {"up_axis", SettingJson(person.report.up_axis)},
          {"remarks", person.report.remarks},
          {"file_joints", person.report.file_joints},
          {"joints", joints},
          {"missing_joints", missing}};
}

std::string DescribeInspection(const Inspection& inspection) {
  std::string text = base::EscapeControls(inspection.file);
  const retargeting::ReadingReport& first = inspection.people[0].report;
  if (!first.format.empty()) absl::StrAppend(&text, ": ", first.format);
  if (first.people > 0) {
    absl::StrAppend(&text, ", ", base::Counted(first.people, "person", "people"),
                    first.people > 2 ? " (the first two are read)" : "");
  }
  const motion::Clip& clip = inspection.people[0].clip;
  if (clip.frame_count() > 0) absl::StrAppend(&text, ", ", DescribeLength(clip));
  text += "\n";
  if (clip.frame_count() > 0 && !first.frame_rate.has_value()) {
    absl::StrAppend(&text, "  frame rate  ", "unknown; specify it with --frame-rate HZ", "\n");
  }
  for (std::size_t i = 0; i < inspection.people.size(); ++i) {
    const InspectedPerson& person = inspection.people[i];
    if (inspection.people.size() > 1) {
      absl::StrAppend(&text, i == 0 ? "  left person" : "  right person", "\n",
                      i == 0 ? "" : DescribeUnlikeLength(clip, person.clip));
    }
    const std::string reading = DescribeReading(person.report);
    const bool repeated = i > 0 && reading == DescribeReading(first);
    absl::StrAppend(&text, repeated ? "  read as the other\n" : reading);
  }
  if (!inspection.status.ok()) {
    absl::StrAppend(&text, "  ", "cannot be read", ": ", inspection.status.message(), "\n");
  }
  return text;
}

json InspectionJson(const Inspection& inspection) {
  const InspectedPerson& first = inspection.people[0];
  json people = json::array();
  for (const InspectedPerson& person : inspection.people) people.push_back(PersonJson(person));
  json object = {{"file", inspection.file},
                 {"readable", inspection.status.ok()},
                 {"format", first.report.format},
                 {"people_count", first.report.people},
                 {"people", people}};
  if (!inspection.status.ok()) {
    object["error"] = inspection.status.message();
    return object;
  }
  object["frames"] = first.clip.frame_count();
  if (first.clip.frame_rate_hz > 0) {
    object["frame_rate_hz"] = first.clip.frame_rate_hz;
    object["seconds"] = first.clip.frame_count() / first.clip.frame_rate_hz;
  }
  return object;
}

struct InspectArguments {
  std::vector<std::filesystem::path> files;
  InputArguments input;
  bool json = false;
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

absl::Status InspectPerson(const std::filesystem::path& file, formats::ReadOptions options,
                           InspectedPerson* person) {
  options.report = &person->report;
  absl::StatusOr<motion::Clip> clip = ReadAtAnyRate(file, options);
  if (!clip.ok()) return clip.status();
  person->clip = *std::move(clip);
  return absl::OkStatus();
}

Inspection Inspect(const std::filesystem::path& file, const InputArguments& input) {
  Inspection inspection;
  inspection.file = file.string();
  inspection.people.emplace_back();
  inspection.status = formats::CheckReadable(file, input.format);
  if (!inspection.status.ok()) return inspection;
  absl::StatusOr<formats::ReadOptions> options = ToReadOptions(input, motion::SbuSkeleton());
  inspection.status = options.status();
  if (!inspection.status.ok()) return inspection;
  inspection.status = InspectPerson(file, *options, &inspection.people[0]);
  if (inspection.status.ok() && inspection.people[0].report.people >= 2) {
    options->side = formats::Side::kRight;
    inspection.people.emplace_back();
    inspection.status = InspectPerson(file, *options, &inspection.people[1]);
  }
  return inspection;
}

ExitCode RunInspect(const InspectArguments& arguments, const ProgramEnvironment& environment) {
  ExitCode worst = kExitDone;
  nlohmann::json files = nlohmann::json::array();
  for (std::size_t i = 0; i < arguments.files.size(); ++i) {
    const Inspection inspection = Inspect(arguments.files[i], arguments.input);
    worst = std::max(worst, ExitCodeFor(inspection.status));
    if (arguments.json) {
      files.push_back(InspectionJson(inspection));
      continue;
    }
    *environment.out << (i == 0 ? "" : "\n") << DescribeInspection(inspection)
                     << (inspection.status.ok() ? "" : DescribeAdvice(inspection.status));
  }
  if (arguments.json) *environment.out << Print({{"files", files}});
  return worst;
}

void AddFlags(CLI::App* command, InspectArguments* arguments) {
  command
      ->add_option("files", arguments->files,
                   absl::StrCat("Motions: ", formats::kReadableExtensions))
      ->required()
      ->type_name("FILE");
  AddInputFlags(command, &arguments->input);
  command->add_flag("--json", arguments->json, "Print JSON")->group(kOutputGroup);
}

}  // namespace

Command AddInspectCommand(CLI::App* program) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* app =
      program->add_subcommand("inspect", "Print what motion files contain and how Duet reads them");
  app->footer(R"(
Examples:
  duet inspect walk.bvh
  duet inspect captures/*.bvh --json
)");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunInspect);
}

}  // namespace duet::client::cli
