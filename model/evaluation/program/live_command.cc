#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/live_reaction.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct LiveArguments {
  std::string data;
  ModelChoice models;
  std::vector<int> delays = {0, 2, 5, 10};
  uint64_t seed = 0;
  SectionFlags section = {"21_live", "Live followers"};
};

double Milliseconds(std::vector<double> seconds, double share) {
  if (seconds.empty()) return NAN;
  std::sort(seconds.begin(), seconds.end());
  return 1000 * seconds[static_cast<size_t>(share * static_cast<double>(seconds.size() - 1))];
}

report::TableRow Row(const std::string& name, const experiments::LiveFigures& figures,
                     double whole_jerk) {
  return {name,
          {Milliseconds(figures.reaction_seconds, 0.5), Milliseconds(figures.reaction_seconds, 0.9),
           100 * static_cast<double>(figures.reaction_seconds.size()) / figures.clips,
           Milliseconds(figures.label_seconds, 0.5), Milliseconds(figures.label_seconds, 0.9),
           figures.speed, figures.jerk / whole_jerk}};
}

absl::StatusOr<report::Table> ModelTable(const LiveArguments& arguments,
                                         const dataset::Dataset& dataset, const std::string& name,
                                         const engine::Synthesizer& model) {
  const std::vector<int> sequences = dataset::AllSequences(dataset);
  report::Table table{absl::StrCat(name, ": reactions to ", sequences.size(), " leaders"),
                      {"reaction", "90 %", "react %", "label", "90 %, label", "speed", "jerk"},
                      {},
                      {},
                      2};
  const auto measure = [&](std::optional<int> delay) {
    return experiments::MeasureLiveReaction(model, dataset, sequences, arguments.seed, delay);
  };
  DUET_TRY(const experiments::LiveFigures whole, measure(std::nullopt));
  table.rows.push_back(Row("whole leader known", whole, whole.jerk));
  for (const int delay : arguments.delays) {
    DUET_TRY(const experiments::LiveFigures live, measure(delay));
    table.rows.push_back(Row(absl::StrCat("live, delay ", delay), live, whole.jerk));
  }
  const std::vector<double> captured = experiments::CapturedReactions(dataset, sequences);
  table.notes = {
      absl::StrCat(
          "Milliseconds. Reaction: from the moment at which a leader who stood for two seconds has "
          "moved by 5 cm, until the follower parts by 5 cm from one with the same seed whose "
          "leader goes on standing: median, and the value of 90 % of the clips; react: in how "
          "many clips it does. Captured followers leave their first pose ",
          std::llround(Milliseconds(captured, 0.5)), " ms (median) after their leaders."),
      "Label: from a change to another class, until the follower of a standing leader parts by 5 "
      "cm from one with the old class. Speed: of the joints, m/s. Jerk: mean of the joints, as a "
      "multiple of the first row's. Delay: in frames of 1/30 s."};
  return table;
}

absl::Status RunLive(const LiveArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  report::ResultSection section = BeginSection(
      arguments.section,
      "How fast live followers react, at 30 frames per second, and how smoothly they move beside "
      "followers of leaders who are known from the start. FID and the other figures of live "
      "answers: duet-eval samples, plausible and dance with --live.");
  section.settings.emplace_back("data", DescribeData(dataset));
  section.settings.emplace_back("seed", absl::StrCat(arguments.seed));
  return FinishModelTables(
      arguments.section, arguments.models,
      [&](const std::string& name, const engine::Synthesizer& model) {
        return ModelTable(arguments, dataset, name, model);
      },
      std::move(section));
}

}  // namespace

void AddLiveCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("live", "How fast and how smoothly live followers react", RunLive, app, chosen);
  arguments->models.as_served = true;
  AddDataFlag(&arguments->data, command);
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddNumber("--delays", &arguments->delays, 0, 10, "delays in frames, one row each", command)
      ->delimiter(',');
  AddSeedFlag(&arguments->seed, command);
  AddSectionFlags(&arguments->section, command);
}

}  // namespace duet::evaluation::program
