#include "client/cli/inspect_command.h"

#include <algorithm>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/inspection.h"
#include "client/cli/motion_input.h"
#include "client/cli/report.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

struct InspectArguments {
  std::vector<std::filesystem::path> files;
  InputArguments input;
  bool json = false;
};

// Allows a motion without a frame rate. This rate is not reported.
constexpr double kStandInRateHz = 30;

// A file without a frame rate can be inspected too.
absl::StatusOr<motion::Clip> ReadAtAnyRate(const MotionInput& input, formats::ReadOptions options) {
  absl::StatusOr<motion::Clip> clip = input.Read(options);
  if (motion::MendingSetting(clip.status()) != motion::ReadingSetting::kFrameRate) return clip;
  options.frame_rate_hz = kStandInRateHz;
  clip = input.Read(options);
  if (!clip.ok()) return clip;
  clip->frame_rate_hz = 0;
  options.report->frame_rate.reset();
  return clip;
}

absl::Status InspectPerson(const MotionInput& input, formats::ReadOptions options,
                           InspectedPerson* person) {
  options.report = &person->report;
  absl::StatusOr<motion::Clip> clip = ReadAtAnyRate(input, options);
  if (!clip.ok()) return clip.status();
  person->clip = *std::move(clip);
  person->checks = analysis::CheckSkeleton(person->clip, options.skeleton);
  return absl::OkStatus();
}

// Whether its people are evidence of the vertical.
bool HasRate(const Inspection& inspection) {
  return inspection.status.ok() && inspection.people[0].clip.frame_rate_hz > 0;
}

void AddPeople(const Inspection& inspection, motion::VerticalEvidence* evidence) {
  for (const InspectedPerson& person : inspection.people) evidence->Add(person.clip);
}

Inspection Inspect(const std::filesystem::path& file, const InputArguments& input_arguments,
                   std::istream* in) {
  Inspection inspection;
  inspection.file = file.string();
  inspection.people.emplace_back();
  inspection.status = CheckInput(file, input_arguments.format);
  if (!inspection.status.ok()) return inspection;
  absl::StatusOr<formats::ReadOptions> options =
      ToReadOptions(input_arguments, motion::SbuSkeleton());
  const absl::StatusOr<MotionInput> input = MotionInput::Open(file, in);
  inspection.status.Update(options.status());
  inspection.status.Update(input.status());
  if (!inspection.status.ok()) return inspection;
  inspection.file = input->name();
  inspection.status = InspectPerson(*input, *options, &inspection.people[0]);
  if (inspection.status.ok() && inspection.people[0].report.people >= 2) {
    options->side = formats::Side::kRight;
    inspection.people.emplace_back();
    inspection.status = InspectPerson(*input, *options, &inspection.people[1]);
  }
  if (HasRate(inspection)) {
    motion::VerticalEvidence evidence(options->skeleton);
    AddPeople(inspection, &evidence);
    inspection.vertical = evidence.Estimate();
  }
  return inspection;
}

ExitCode RunInspect(const InspectArguments& arguments, const ProgramEnvironment& environment) {
  const Style style = environment.OutStyle();
  ExitCode worst = kExitDone;
  nlohmann::json files = nlohmann::json::array();
  motion::VerticalEvidence evidence(motion::SbuSkeleton());
  for (std::size_t i = 0; i < arguments.files.size(); ++i) {
    const Inspection inspection = Inspect(arguments.files[i], arguments.input, environment.in);
    worst = std::max(worst, ExitCodeFor(inspection.status));
    if (HasRate(inspection)) AddPeople(inspection, &evidence);
    if (arguments.json) {
      files.push_back(InspectionJson(inspection));
      continue;
    }
    *environment.out << (i == 0 ? "" : "\n") << DescribeInspection(inspection, style)
                     << (inspection.status.ok() ? "" : DescribeAdvice(inspection.status));
  }
  const motion::VerticalEstimate together = evidence.Estimate();
  if (arguments.json) {
    *environment.out << Print({{"files", files}, {"tilt", VerticalJson(together)}});
  } else if (arguments.files.size() > 1) {
    *environment.out << "\n"
                     << style.Heading("all files, if one camera captured them") << "\n"
                     << "  tilt        " << DescribeVertical(together) << "\n";
  }
  return worst;
}

void AddFlags(FlagSet* command, InspectArguments* arguments) {
  command
      ->Add("files", &arguments->files,
            absl::StrCat("Motions: ", formats::kReadableExtensions, "; - for standard input"))
      ->Required()
      ->Form("FILE");
  AddInputFlags(command, &arguments->input);
  command->AddSwitch("--json", &arguments->json, "Print JSON")->Group(kOutputGroup);
}

}  // namespace

Command AddInspectCommand(FlagSet* program) {
  const auto arguments = std::make_shared<InspectArguments>();
  FlagSet* app = program->AddCommand(
      "inspect", "Print what motion files contain, how Duet reads them, and what looks wrong");
  app->Footer(R"(
Examples:
  duet inspect walk.bvh
  duet inspect captures/*.bvh --json

duet help exit-codes explains the exit codes.
)");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunInspect);
}

}  // namespace duet::client::cli
