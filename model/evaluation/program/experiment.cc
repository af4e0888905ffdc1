#include "model/evaluation/program/experiment.h"

#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/clips_together.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;

// Bounds the memory of one evaluation; beyond it batches gain little.
constexpr size_t kClipsTogether = 64;

engine::ClipRequest MakeRequest(const motion::Skeleton& skeleton, const LabelledLeader& labelled,
                                const Asked& asked) {
  const dataset::Sequence& sequence = *labelled.sequence;
  const motion::Clip& leader = sequence.pair.leader;
  const motion::Clip& follower = sequence.pair.follower;
  const engine::Sampling sampling = {labelled.seed, asked.variety, asked.candidates,
                                     asked.reaction};
  engine::ClipRequest request{
      leader.poses, leader.frame_rate_hz,       engine::LabelTrack(labelled.labels),
      std::nullopt, sequence.partner_direction, {sampling, {}}};
  if (asked.start == "none") return request;
  request.start = engine::FollowerStart{follower.at(0, skeleton.root), {}};
  if (asked.start == "pose") {
    request.start->pose.assign(follower.poses[0].begin(), follower.poses[0].end());
  }
  return request;
}

// Answers leaders together, as clips of either kind.
template <typename Clip, typename... Delay>
absl::StatusOr<std::vector<motion::Poses>> SynthesizeAs(const engine::Synthesizer& synthesizer,
                                                        absl::Span<const LabelledLeader> leaders,
                                                        const Asked& asked, Delay... delay) {
  const engine::ModelDescription& model = synthesizer.description();
  std::vector<Clip> clips;
  for (const LabelledLeader& leader : leaders) {
    clips.emplace_back(model, MakeRequest(model.skeleton, leader, asked), delay...);
  }
  return engine::SynthesizeTogether(synthesizer, &clips);
}

struct Command {
  const char* name;
  const char* id;     // of its section, unless --id is given
  const char* title;  // likewise
  const char* help;
  Measure (*add)(CLI::App* command);
};

constexpr Command kCommands[] = {
    {"folds", "10_folds", "Leave one subject out",
     "Figures of models and baselines, leaving one subject out", AddFoldsCommand},
    {"samples", "14_samples", "Many answers to one leader",
     "Figures of many answers to each leader", AddSamplesCommand},
    {"told-apart", "17_told_apart", "Told apart from captured pairs",
     "How well a classifier distinguishes answers from captured pairs", AddToldApartCommand},
    {"plausible", "19_plausible", "Plausible followers of foreign leaders",
     "What a viewer would notice in followers of any leaders", AddPlausibleCommand},
    {"sweep", "30_sweep", "Mix, match and avoid: what label weights do",
     "Effect of raising and lowering label weights", AddSweepCommand},
    {"mixes", "32_mixes", "Mixes", "What mixes do", AddMixesCommand},
    {"augmentation", "40_augmentation", "Synthetic motion as training material (Table 6)",
     "A classifier with and without synthetic training motion (Table 6)", AddAugmentationCommand},
    {"latent", "50_latent", "Latent space (Figures 6 and 7)",
     "Maps of the generator's latent space (Figures 6 and 7)", AddLatentCommand},
};

struct Output {
  std::string folder;  // empty: only print
  std::string id, title;
};

absl::Status Run(const CLI::App& command, const Measure& measure, const Output& output) {
  DUET_TRY(report::Section section, measure());
  section.id = output.id;
  section.title = output.title;
  section.command = RecordedCommand(command);
  for (report::Figure& figure : section.figures) {
    figure.name = absl::StrCat(section.id, "_", figure.name);
  }
  for (const std::string& text : section.text) std::cout << text << "\n\n";
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return output.folder.empty() ? absl::OkStatus() : WriteSection(section, output.folder);
}

}  // namespace

CLI::Option* AddNames(const char* name, std::vector<std::string>* values,
                      const std::vector<std::string>& among, const char* help, CLI::App* command) {
  return AddOption(name, values, help, command)->delimiter(',')->check(CLI::IsMember(among));
}

CLI::Option* AddFolder(const char* name, std::string* folder, const char* help, CLI::App* command) {
  return command->add_option(name, *folder, help)->type_name(kFolder);
}

void AddExperimentFlags(ExperimentFlags* flags, CLI::App* command) {
  AddFolder("--data", &flags->data, "folder of captures (docs/datasets.md)", command)->required();
  command
      ->add_option("--subjects", flags->subjects,
                   "subjects to leave out, one at a time (default: every subject)")
      ->delimiter(',');
}

void AddModelFlags(ExperimentFlags* flags, CLI::App* command) {
  CLI::Option* runs =
      command->add_option("--runs", flags->runs, "output of duet-train --protocol loso; repeatable")
          ->type_name(kRuns)
          ->allow_extra_args(false);
  CLI::Option* checkpoint = AddFolder("--checkpoint", &flags->checkpoint,
                                      "one checkpoint folder for every fold", command);
  CLI::Option* embedded =
      command->add_flag("--embedded", flags->embedded, "the embedded checkpoint");
  runs->excludes(checkpoint, embedded);
  checkpoint->excludes(embedded);
  command->add_flag("--as-served", flags->as_served,
                    "finish the answers as a server does (default: the network's own answers)");
}

void AddStartsFlag(ExperimentFlags* flags, CLI::App* command) {
  AddNames("--starts", &flags->starts, {"none", "root", "pose"},
           "input about the follower's first frame; one row per value", command);
}

void AddSamplingFlags(Asked* asked, CLI::App* command) {
  AddNumber("--samples", &asked->samples, 1, 1000, "answers to each leader by a model that samples",
            command);
  AddNumber("--variety", &asked->variety, 0.0, 2.0,
            "variety of sampled answers; 0: the typical answer, 1: as varied as people", command);
  AddNumber("--candidates", &asked->candidates, 1, engine::kMostCandidates,
            "samples of each window, of which the best is taken", command);
  AddNumber("--reaction", &asked->reaction, 0.0, double{engine::kMostReaction},
            "factor of what the leader's motion changes in an answer", command);
  AddOption("--seed", &asked->seed, "seed of the answers", command);
  command
      ->add_option("--live", asked->live_delay,
                   "answer as in a live session, this number of leader frames later; without it, "
                   "the whole leader is known")
      ->check(CLI::Range(0, 10));
}

void AddAnswersFlags(ExperimentFlags* flags, CLI::App* command) {
  AddExperimentFlags(flags, command);
  AddModelFlags(flags, command);
  AddStartsFlag(flags, command);
  AddSamplingFlags(&flags->asked, command);
}

absl::StatusOr<NamedRuns> ParseRuns(const std::string& text) {
  const size_t equals = text.find('=');
  NamedRuns runs{text.substr(0, equals), text};
  if (equals == std::string::npos) {
    // "runs/" ends in an empty part.
    const fs::path path = (fs::path(text) / "").parent_path();
    runs.name = path.lexically_normal().filename().string();
  } else {
    runs.folder = text.substr(equals + 1);
  }
  if (!runs.name.empty() && !runs.folder.empty()) return runs;
  return absl::InvalidArgumentError(
      absl::StrCat("--runs: expected NAME=DIR or DIR, got ", base::Quoted(text)));
}

absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const fs::path& run) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& name : fs::directory_iterator(run / "checkpoint", error)) {
    for (const auto& version : fs::directory_iterator(name.path(), error)) {
      // A dot marks an unfinished write of an interrupted run.
      if (version.path().filename().string().front() != '.') found.push_back(version.path());
    }
  }
  if (found.size() == 1) return checkpoint::ReadCheckpoint(found[0]);
  return absl::NotFoundError(absl::StrCat(run.string(),
                                          ": expected one finished run of duet-train, got ",
                                          found.size(), " checkpoints"));
}

absl::StatusOr<std::vector<FoldModel>> OpenModels(const ExperimentFlags& flags) {
  const cpu_engine::CpuEngineOptions options{flags.as_served,
                                             cpu_engine::kernels::Precision::kFloat32};
  std::vector<FoldModel> models;
  if (flags.embedded || !flags.checkpoint.empty()) {
    SharedSynthesizer one;
    if (flags.embedded) {
      DUET_TRY(auto all, cpu_engine::LoadEmbeddedSynthesizers(options));
      one = std::move(all.front());
    } else {
      DUET_TRY(one, cpu_engine::LoadCpuSynthesizer(flags.checkpoint, options));
    }
    models.push_back({"duet", [one](const std::string&) { return one; }, flags.asked});
  }
  for (const std::string& text : flags.runs) {
    DUET_TRY(NamedRuns runs, ParseRuns(text));
    models.push_back({runs.name,
                      [folder = runs.folder,
                       options](const std::string& subject) -> absl::StatusOr<SharedSynthesizer> {
                        DUET_TRY(const auto checkpoint, ReadRunCheckpoint(folder / subject));
                        return cpu_engine::MakeCpuSynthesizer(checkpoint, options);
                      },
                      flags.asked});
  }
  return models;
}

absl::StatusOr<std::vector<Fold>> LeaveOut(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& asked) {
  std::vector<Fold> folds;
  for (const std::string& subject : asked.empty() ? dataset.Subjects() : asked) {
    DUET_TRY(dataset::Split split, LeaveSubjectOut(dataset, subject));
    folds.push_back({subject, std::move(split)});
  }
  if (!folds.empty()) return folds;
  return LeaveSubjectOut(dataset, "").status();  // says that there is nobody
}

absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(flags.data));
  DUET_TRY(std::vector<Fold> folds, LeaveOut(dataset, flags.subjects));
  DUET_TRY(const std::vector<FoldModel> models, OpenModels(flags));
  Experiment experiment{std::move(dataset), std::move(folds), {}};
  for (const std::string& start : flags.starts) {
    for (const FoldModel& model : models) {
      FoldModel& started = experiment.models.emplace_back(model);
      started.asked.start = start;
      if (start != "none") absl::StrAppend(&started.name, "+", start);
    }
  }
  return experiment;
}

std::string DescribeData(const dataset::Dataset& dataset) {
  return absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences");
}

report::Section BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                const std::string& text) {
  report::Section section;
  section.text = {text};
  if (flags.embedded || !flags.checkpoint.empty()) {
    section.text.push_back(
        "One checkpoint for every fold: it may have been trained on what is tested.");
  }
  std::vector<std::string> subjects;
  for (const Fold& fold : experiment.folds) subjects.push_back(fold.subject);
  section.settings = {{"data", DescribeData(experiment.dataset)},
                      {"left out in turn", absl::StrJoin(subjects, ", ")},
                      {"models' answers", flags.as_served ? "as served" : "the network's own"}};
  return section;
}

absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             const std::string& start) {
  if (model.classes != dataset.classes) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its classes are ", absl::StrJoin(model.classes, ", "),
                     ", the data's ", absl::StrJoin(dataset.classes, ", ")));
  }
  if (model.skeleton.joint_names != dataset.skeleton.joint_names) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": its joints are not the data's"));
  }
  if (start != "none" && !model.accepts_follower_start) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", model.name, ": does not accept a follower start"));
  }
  return absl::OkStatus();
}

std::vector<float> OneClass(int classes, int interaction_class) {
  std::vector<float> weights(static_cast<size_t>(classes));
  weights[static_cast<size_t>(interaction_class)] = 1;
  return weights;
}

absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    const Asked& asked) {
  if (asked.live_delay && !engine::AnswersLive(synthesizer.description())) {
    return absl::FailedPreconditionError(
        absl::StrCat("model ", synthesizer.description().name, ": does not answer live"));
  }
  std::vector<motion::Poses> followers;
  for (size_t first = 0; first < leaders.size(); first += kClipsTogether) {
    const auto some = leaders.subspan(first, kClipsTogether);
    DUET_TRY(std::vector<motion::Poses> more,
             asked.live_delay
                 ? SynthesizeAs<engine::LiveClip>(synthesizer, some, asked, *asked.live_delay)
                 : SynthesizeAs<engine::ClipSynthesis>(synthesizer, some, asked));
    std::move(more.begin(), more.end(), std::back_inserter(followers));
  }
  return followers;
}

uint64_t SeedOf(const Asked& asked, const dataset::Dataset& dataset, int sequence, int n) {
  const uint64_t set = asked.seed + static_cast<uint64_t>(n);
  return set * dataset.sequences.size() + static_cast<uint64_t>(sequence);
}

absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          const Asked& asked) {
  DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer.description(), dataset, asked.start));
  const int samples = synthesizer.description().samples ? asked.samples : 1;
  std::vector<LabelledLeader> leaders;
  for (int n = 0; n < samples; ++n) {
    for (const int index : sequences) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      leaders.push_back({&sequence, OneClass(dataset.class_count(), sequence.interaction_class),
                         SeedOf(asked, dataset, index, n)});
    }
  }
  DUET_TRY(auto followers, SynthesizeSequences(synthesizer, leaders, asked));
  metrics::SampledMotions answers(static_cast<size_t>(samples));
  auto follower = followers.begin();
  for (std::vector<metrics::ScoredMotion>& set : answers) {
    for (const int index : sequences) set.push_back({index, std::move(*follower++)});
  }
  return answers;
}

absl::StatusOr<std::vector<judge::MotionClassifier>> TrainJudges(const dataset::Dataset& dataset,
                                                                 const std::vector<Fold>& folds) {
  judge::MotionClassifierOptions options;
  // The results of one network for an unseen person depend on its seed: several are averaged.
  options.members = 4;
  std::vector<judge::MotionClassifier> judges;
  for (const Fold& fold : folds) {
    DUET_TRY(judge::MotionClassifier judge,
             judge::MotionClassifier::Train(
                 dataset, metrics::CapturedMotions(dataset, fold.split.train), options));
    judges.push_back(std::move(judge));
    std::cerr << "judge without " << fold.subject << ": " << fold.split.train.size()
              << " motions\n";
  }
  return judges;
}

void AddCommands(CLI::App* app, std::function<absl::Status()>* chosen) {
  app->require_subcommand(1);
  for (const Command& one : kCommands) {
    CLI::App* command = app->add_subcommand(one.name, one.help);
    const Measure measure = one.add(command);
    const auto output = std::make_shared<Output>(Output{"", one.id, one.title});
    command
        ->add_option("--out", output->folder,
                     "folder for the results, which scripts/make_report.py reads")
        ->type_name(kFolder);
    command->add_option("--id", output->id, "id of the section")->capture_default_str();
    command->add_option("--title", output->title, "title of the section")->capture_default_str();
    command->callback([=] { *chosen = [=] { return Run(*command, measure, *output); }; });
  }
}

std::string RecordedCommand(const CLI::App& command) {
  std::string line = absl::StrCat("duet-eval ", command.get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    absl::StrAppend(&line, " ", option->get_name());
    if (option->get_expected_max() == 0) continue;  // a flag without a value
    std::vector<std::string> values = option->results();
    const std::string type = option->get_type_name();
    for (std::string& value : values) {
      if (type == kRuns) value = absl::StrCat(value.substr(0, value.find('=') + 1), "RUNS");
      if (type.rfind(kFolder, 0) == 0) value = kFolder;  // names of checks may follow
      if (value.find(' ') != std::string::npos) value = absl::StrCat("'", value, "'");
    }
    const bool listed = option->get_delimiter() != '\0';
    absl::StrAppend(
        &line, " ",
        absl::StrJoin(values, listed ? "," : absl::StrCat(" ", option->get_name(), " ")));
  }
  return line;
}

}  // namespace duet::evaluation::program
