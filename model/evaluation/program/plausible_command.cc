#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/body/grade.h"
#include "model/body/hands.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/long_leaders.h"
#include "model/evaluation/experiments/synthesizer_method.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/posture.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/result_section.h"
#include "model/formats/motion_file.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;
using motion::Poses;

// A clip counts as twisted from this angle between shoulders and hips on, in any frame.
constexpr double kTwistedClipDegrees = 60;

struct Arguments {
  std::string leaders;
  double seconds = 60;
  ModelChoice models;
  experiments::AskedSamples asked;
  SectionFlags section;
};

std::vector<std::string> Columns() {
  return {"twisted clips", "twisted", "both feet", "leader's", "heads",
          "trunks",        "hands",   "distance",  "speed",    "lean"};
}

// The figures of one follower, in the order of the columns.
class Measure {
 public:
  explicit Measure(const motion::Skeleton& skeleton)
      : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

  bool possible() const { return body::PairMeter::CanMeasure(skeleton_, body_); }

  std::vector<double> operator()(const Poses& leader, const Poses& follower, double rate) const {
    body::PairMeter meter(skeleton_, body_, rate);
    body::GradeSum sum;
    double most_twisted = 0, heads = 0, trunks = 0;
    for (int t = 0; t < leader.frame_count(); ++t) {
      const body::FrameMeasures frame = meter.Add(leader[t], follower[t]);
      sum.Add(frame);
      most_twisted = std::max(most_twisted, frame.twist_degrees);
      heads += frame.head_overlap > 0;
      trunks += frame.trunk_overlap > 0;
    }
    const body::Grade grade = sum.Get();
    return {most_twisted > kTwistedClipDegrees ? 1.0 : 0.0,
            grade.twisted,
            grade.skating,
            grade.leader_skating,
            heads / leader.frame_count(),
            trunks / leader.frame_count(),
            HandsApart(leader, follower),
            metrics::RootDistance(leader, follower, skeleton_),
            metrics::JointSpeed(motion::WithoutNoise(follower, rate), rate),
            metrics::MeasureLean(follower, skeleton_, rate, metrics::LeanFrom::kHips).max_degrees};
  }

 private:
  // The mean distance of a hand that the leader offers from the nearest hand of the follower; NaN
  // if no hand is offered.
  double HandsApart(const Poses& leader, const Poses& follower) const {
    std::vector<double> nearest;
    for (int t = 0; t < leader.frame_count(); ++t) {
      for (const body::Limb& arm : body_.arms) {
        if (body::ReachTowards(arm, skeleton_.root, leader[t], follower.at(t, skeleton_.root)) <
            body::kOffersReach) {
          continue;
        }
        nearest.push_back(HUGE_VAL);
        for (const body::Limb& other : body_.arms) {
          nearest.back() = std::min(
              nearest.back(), double{Distance(leader.at(t, arm.end), follower.at(t, other.end))});
        }
      }
    }
    return base::Mean(nearest);
  }

  const motion::Skeleton& skeleton_;
  body::Body body_;
};

// The motion files below a folder as leaders of a model, in the order of their paths, each cut to
// `seconds`. Reports files that cannot be read, and leaves them out.
std::vector<dataset::Sequence> ReadLeaders(const Arguments& arguments,
                                           const motion::Skeleton& skeleton) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(arguments.leaders)) {
    if (entry.is_regular_file() && formats::IsReadable(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<dataset::Sequence> leaders;
  formats::ReadOptions options;
  options.skeleton = skeleton;
  for (const fs::path& file : files) {
    absl::StatusOr<motion::Clip> leader = formats::ReadLeader(file, options);
    if (!leader.ok()) {
      std::cerr << absl::StrCat("left out: ", leader.status().message(), "\n");
      continue;
    }
    const int most = static_cast<int>(arguments.seconds * leader->frame_rate_hz);
    if (leader->frame_count() > most) leader->poses.Resize(most);
    dataset::Sequence sequence;
    sequence.id = file.filename().string();
    sequence.pair.leader = *std::move(leader);
    leaders.push_back(std::move(sequence));
  }
  return leaders;
}

// The leaders that formulas make (long_leaders.h), for models with their joints.
std::vector<dataset::Sequence> MadeLeaders(double seconds, const engine::ModelDescription& model) {
  std::vector<dataset::Sequence> leaders;
  if (model.skeleton.joint_names != motion::SbuSkeleton().joint_names) return leaders;
  for (const std::string& name : experiments::MadeLeaderNames()) {
    dataset::Sequence sequence;
    sequence.id = name;
    sequence.pair.leader = {model.skeleton.joint_names, model.frame_rate_hz,
                            experiments::MakeLeader(name, seconds, model.frame_rate_hz)};
    leaders.push_back(std::move(sequence));
  }
  return leaders;
}

// The mean of each column over all leaders and seeds, for one class.
absl::StatusOr<std::vector<double>> ClassFigures(const Arguments& arguments,
                                                 const engine::Synthesizer& synthesizer,
                                                 const std::vector<dataset::Sequence>& leaders,
                                                 int label, const Measure& measure) {
  std::vector<std::vector<double>> columns(Columns().size());
  std::vector<float> weights(synthesizer.description().classes.size());
  weights[static_cast<size_t>(label)] = 1;
  for (int n = 0; n < arguments.asked.samples; ++n) {
    std::vector<experiments::LabelledLeader> asked;
    for (const dataset::Sequence& leader : leaders) {
      const uint64_t seed = arguments.asked.seed + asked.size() * 1000 + static_cast<uint64_t>(n);
      asked.push_back({&leader,
                       engine::LabelTrack(weights),
                       {seed, arguments.asked.variety, arguments.asked.candidates},
                       true,
                       arguments.asked.live_delay});
    }
    absl::StatusOr<std::vector<Poses>> followers =
        SynthesizeSequences(synthesizer, asked, experiments::StartGiven::kNone);
    if (!followers.ok()) return followers.status();
    for (size_t i = 0; i < leaders.size(); ++i) {
      const motion::Clip& leader = leaders[i].pair.leader;
      const std::vector<double> figures =
          measure(leader.poses, (*followers)[i], leader.frame_rate_hz);
      for (size_t c = 0; c < figures.size(); ++c) {
        if (!std::isnan(figures[c])) columns[c].push_back(figures[c]);
      }
    }
  }
  std::vector<double> means;
  for (const std::vector<double>& column : columns) means.push_back(base::Mean(column));
  return means;
}

absl::StatusOr<report::Table> ModelTable(const Arguments& arguments, const std::string& name,
                                         const engine::Synthesizer& synthesizer) {
  const engine::ModelDescription& model = synthesizer.description();
  const Measure measure(model.skeleton);
  if (!measure.possible()) {
    return absl::InvalidArgumentError(
        absl::StrCat(name,
                     ": expected a skeleton with hips, feet, a chest and two arms whose "
                     "joints are named left and right"));
  }
  std::vector<dataset::Sequence> leaders = ReadLeaders(arguments, model.skeleton);
  if (leaders.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("--leaders: expected a folder with motion files, got ", arguments.leaders));
  }
  for (dataset::Sequence& made : MadeLeaders(arguments.seconds, model)) {
    leaders.push_back(std::move(made));
  }
  report::Table table;
  table.title = absl::StrCat(name, ": followers of ", leaders.size(), " leaders");
  table.columns = Columns();
  std::vector<std::vector<double>> columns(table.columns.size());
  for (int c = 0; c < model.class_count(); ++c) {
    absl::StatusOr<std::vector<double>> row =
        ClassFigures(arguments, synthesizer, leaders, c, measure);
    if (!row.ok()) return row.status();
    for (size_t i = 0; i < row->size(); ++i) columns[i].push_back((*row)[i]);
    table.rows.push_back({model.classes[static_cast<size_t>(c)], *std::move(row)});
  }
  report::TableRow mean{"mean", {}};
  for (const std::vector<double>& column : columns) mean.values.push_back(base::Mean(column));
  table.rows.push_back(std::move(mean));
  table.decimals = 3;
  table.notes = {
      "Twisted clips: share of answers in which shoulders and hips differ by more than 60 degrees "
      "in any frame. Twisted: share of frames above 45 degrees. Both feet: share of frames in "
      "which the slower ankle moves faster than 10 cm/s; leader's: the same of the leaders.",
      "Heads, trunks: share of frames in which the heads are nearer than 18 cm, the axes of the "
      "trunks nearer than 16 cm. Hands: mean distance of a hand that the leader reaches out from "
      "the follower's nearest hand, metres. Distance: of the roots, metres. Speed: of the joints, "
      "m/s. Lean: largest of the trunk over one second, degrees."};
  return table;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(arguments.models);
  if (!models.ok()) return models.status();
  report::ResultSection section =
      BeginSection(arguments.section,
                   "What a viewer would notice in followers of leaders that the model never saw: "
                   "every motion file below a folder and, for the skeleton of SBU, four that "
                   "formulas make, answered in every class at weight 1 without "
                   "a start.");
  section.settings.emplace_back("seeds", absl::StrCat(arguments.asked.samples));
  section.settings.emplace_back("candidates", absl::StrCat(arguments.asked.candidates));
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  section.settings.emplace_back("live", LiveText(arguments.asked));
  for (const FoldModel& model : *models) {
    absl::StatusOr<SharedSynthesizer> synthesizer = model.load("");
    if (!synthesizer.ok()) return synthesizer.status();
    absl::StatusOr<report::Table> table = ModelTable(arguments, model.name, **synthesizer);
    if (!table.ok()) return table.status();
    section.tables.push_back(*std::move(table));
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddPlausibleCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->models.as_served = true;
  arguments->asked.samples = 1;
  CLI::App* command =
      app->add_subcommand("plausible", "What a viewer would notice in followers of any leaders");
  arguments->section.id = "19_plausible";
  arguments->section.title = "Plausible followers of foreign leaders";
  AddSectionFlags(&arguments->section, command);
  command->add_option("--leaders", arguments->leaders, "folder of motion files, with subfolders")
      ->type_name(kData)
      ->check(CLI::ExistingDirectory)
      ->required();
  command->add_option("--seconds", arguments->seconds, "longest leader; longer ones are cut")
      ->check(CLI::Range(1.0, 600.0))
      ->capture_default_str();
  command
      ->add_option("--samples", arguments->asked.samples,
                   "answers to each leader, each with its seed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddSamplingFlags(&arguments->asked, command);
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
