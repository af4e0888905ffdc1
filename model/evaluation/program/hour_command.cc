#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/authoring/made_leaders.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/experiments/live_hour.h"
#include "model/evaluation/experiments/looped_leaders.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

// So that every class is seen many times, and the first and the last minute have the same one.
constexpr double kSecondsOfAClass = 60;

struct HourArguments {
  ModelChoice models;
  double minutes = 60;
  double rate = 30;
  int delay = 0;
  uint64_t seed = 0;
  SectionFlags section = {"22_hour", "An hour of live followers"};
};

// A class each minute, in their order; in the last one, the first.
engine::LabelTrack ClassAfterClass(int classes, double seconds, double rate) {
  engine::LabelTrack labels(experiments::OneClass(classes, 0));
  const int minutes = static_cast<int>(std::ceil(seconds / kSecondsOfAClass));
  for (int m = 1; m < minutes; ++m) {
    const int own = m + 1 == minutes ? 0 : m % classes;
    const int frame = static_cast<int>(std::lround(m * kSecondsOfAClass * rate));
    labels.Change(frame, /*ease_frames=*/0, experiments::OneClass(classes, own));
  }
  return labels;
}

absl::StatusOr<report::Table> ModelTable(const HourArguments& arguments, const std::string& name,
                                         const engine::Synthesizer& model) {
  const engine::ModelDescription& description = model.description();
  if (description.skeleton.joint_names != motion::SbuSkeleton().joint_names) {
    return absl::FailedPreconditionError(absl::StrCat(
        name, ": expected a model with the joints of SBU, which the leaders have, got ",
        description.skeleton.joint_names.size(), " other joints"));
  }
  std::vector<dataset::Sequence> leaders;
  for (const char* const leader : authoring::kHourLeaders) {
    leaders.push_back(
        experiments::MakeLeaderSequence(leader, 60 * arguments.minutes, arguments.rate));
  }
  std::vector<experiments::LabelledLeader> asked;
  for (const dataset::Sequence& leader : leaders) {
    asked.push_back(
        {&leader,
         ClassAfterClass(description.class_count(), 60 * arguments.minutes, arguments.rate),
         engine::Sampling{arguments.seed + asked.size()}, /*tell_direction=*/false,
         arguments.delay});
  }
  DUET_TRY(auto followers, SynthesizeSequences(model, asked, experiments::StartGiven::kNone));
  report::Table table{
      absl::StrCat(name, ": ", arguments.minutes, " minutes"),
      {"lean", "nearest", "farthest", "out %", "out s", "feet", "first", "last", "last / first"},
      {},
      {},
      3};
  for (size_t i = 0; i < leaders.size(); ++i) {
    const experiments::LiveHourFigures figures = experiments::MeasureLiveHour(
        description.skeleton, leaders[i].pair.leader.poses, followers[i], arguments.rate);
    table.rows.push_back(
        {leaders[i].id,
         {figures.trunk_lean, figures.nearest, figures.farthest, 100 * figures.out_of_range,
          figures.longest_outside, figures.feet, figures.first_speed, figures.last_speed,
          figures.last_speed / figures.first_speed}});
  }
  table.notes = {
      "Lean: of the trunk, degrees, the largest mean over one second; wanted: at most 20.",
      absl::StrCat("Nearest, farthest: the roots along the floor, metres; out: the share of frames "
                   "outside the wanted ",
                   experiments::kNearestWanted, " to ", experiments::kFarthestWanted,
                   ", and the longest time there, seconds."),
      "Feet: the largest distance of the lower foot from the floor, metres; wanted: at most 0.05.",
      "First, last: mean speed of the joints in the first and the last minute, in the same class, "
      "m/s; wanted: a ratio of 0.8 to 1.25."};
  return table;
}

absl::Status RunHour(const HourArguments& arguments) {
  report::ResultSection section = BeginSection(
      arguments.section,
      "Long live sessions with leaders that formulas make: one stands and sways, one whirls, leaps "
      "and rushes about, one walks while frames stop for a tenth of a second to half a minute, and "
      "one dances and is elsewhere every few seconds. The class changes every minute.");
  section.settings.emplace_back("minutes", absl::StrCat(arguments.minutes));
  section.settings.emplace_back("frames per second", absl::StrCat(arguments.rate));
  section.settings.emplace_back("delay", absl::StrCat(arguments.delay));
  section.settings.emplace_back("seed", absl::StrCat(arguments.seed));
  return FinishModelTables(
      arguments.section, arguments.models,
      [&](const std::string& name, const engine::Synthesizer& model) {
        return ModelTable(arguments, name, model);
      },
      std::move(section));
}

}  // namespace

void AddHourCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("hour", "Posture and place of live followers for an hour", RunHour, app, chosen);
  arguments->models.as_served = true;
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddNumber("--minutes", &arguments->minutes, 0.1, 240.0, "length of each session", command);
  AddNumber("--rate", &arguments->rate, 10.0, 120.0, "leader frames per second", command);
  AddNumber("--delay", &arguments->delay, 0, 10, "delay in frames", command);
  AddSeedFlag(&arguments->seed, command);
  AddSectionFlags(&arguments->section, command);
}

}  // namespace duet::evaluation::program
