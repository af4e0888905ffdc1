#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/authoring/made_leaders.h"
#include "model/base/split_mix.h"
#include "model/base/status_macros.h"
#include "model/body/build.h"
#include "model/dataset/dataset.h"
#include "model/dataset/lone_leaders.h"
#include "model/engine/live_synthesis.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/experiments/plausibility.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/result_section.h"
#include "model/formats/motion_file.h"
#include "model/motion/resample.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;
using motion::Poses;

// Length of the pictures of the worst answers.
constexpr double kPictureSeconds = 4;
// Leaders who do not move, for measurements of stillness: their length, unless --seconds is less;
// the beginning, in which a follower may still come to rest; and the end.
constexpr double kStillSeconds = 15, kSettlingSeconds = 3, kLastSeconds = 2;

struct PlausibleArguments {
  std::string leaders;
  double seconds = 60;
  std::string data;   // captured pairs; may be empty
  int worst = 0;      // answers to picture
  bool each = false;  // a row for each answer, too
  bool still = true;  // also leaders who do not move
  ModelChoice models;
  experiments::AskedSamples asked;
  SectionFlags section = {"19_plausible", "Plausible followers of foreign leaders"};
};

// The motion files below a folder as leaders of a model, in the order of their paths, each cut to
// `seconds`. Reports files that cannot be read, and leaves them out.
absl::StatusOr<std::vector<dataset::Sequence>> ReadLeaders(const PlausibleArguments& arguments,
                                                           const motion::Skeleton& skeleton) {
  DUET_TRY(const std::vector<fs::path> files, dataset::MotionFilesBelow(arguments.leaders));
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

// An answer to a leader, and its figures.
struct Answer {
  const dataset::Sequence* leader;
  int label;
  uint64_t seed;
  Poses follower;
  experiments::PairFigures figures;
  experiments::WorstPart worst;
};

// How people meet in a class of a model.
experiments::ClassContacts ContactsOf(const engine::ModelDescription& model, int label) {
  const std::string& name = model.classes[static_cast<size_t>(label)];
  experiments::ClassContacts contacts;
  for (const engine::HandContact& contact : model.hand_contacts) {
    contacts.hands_meet |= contact.interaction_class == name;
  }
  return contacts;
}

// The n-th seed of the answers: one that a server gives callers who name none, if the model has a
// list of them.
uint64_t SeedOf(const engine::ModelDescription& model, uint64_t n) {
  const std::vector<uint64_t>& seeds = model.default_seeds;
  return seeds.empty() ? n : seeds[base::SplitMix(n, 1) % seeds.size()];
}

// The answers to all leaders with one seed each, for one class.
absl::Status AddAnswers(const PlausibleArguments& arguments, const engine::Synthesizer& synthesizer,
                        const std::vector<dataset::Sequence>& leaders, int label, int sample,
                        const experiments::Plausibility& plausibility,
                        std::vector<Answer>* answers) {
  const engine::ModelDescription& model = synthesizer.description();
  const engine::LabelTrack labels(experiments::OneClass(model.class_count(), label));
  std::vector<experiments::LabelledLeader> asked;
  for (const dataset::Sequence& leader : leaders) {
    const uint64_t n = arguments.asked.seed + asked.size() * 1000 + static_cast<uint64_t>(sample);
    asked.push_back(Ask(leader, labels, arguments.asked, SeedOf(model, n)));
  }
  DUET_TRY(auto followers, SynthesizeSequences(synthesizer, asked, experiments::StartGiven::kNone));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const motion::Clip& leader = leaders[i].pair.leader;
    Answer answer{&leaders[i], label, asked[i].sampling.seed, std::move(followers[i]), {}, {}};
    answer.figures = plausibility.Measure(leader.poses, answer.follower, leader.frame_rate_hz,
                                          ContactsOf(model, label));
    answer.worst = experiments::FindWorstPart(
        answer.figures.faults, static_cast<int>(kPictureSeconds * leader.frame_rate_hz));
    answer.worst.faults /= leader.frame_rate_hz;
    answers->push_back(std::move(answer));
  }
  return absl::OkStatus();
}

// A table with a column for each figure of an answer.
report::Table FiguresTable(const std::string& title) {
  report::Table table{title};
  for (const experiments::PairFigure& figure : experiments::Plausibility::Figures()) {
    table.columns.push_back(figure.name);
  }
  table.decimals = 3;
  return table;
}

// A row for each class with the figures of its pairs, and their mean. Shapes: pairs [classes].
report::Table FiguresTable(const std::string& title, const std::vector<std::string>& classes,
                           const std::vector<std::vector<experiments::PairFigures>>& pairs) {
  report::Table table = FiguresTable(title);
  std::vector<std::vector<double>> rows;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (pairs[c].empty()) continue;
    rows.push_back(experiments::Combine(pairs[c]));
    table.rows.push_back({classes[c], rows.back()});
  }
  table.rows.push_back({"mean", report::ColumnMeans(rows)});
  table.notes = experiments::Plausibility::Notes();
  return table;
}

const char* SideOf(absl::string_view joint_name) {
  if (absl::StrContains(joint_name, "left")) return "left";
  return absl::StrContains(joint_name, "right") ? "right" : "middle";
}

nlohmann::ordered_json BonesToJson(const motion::Skeleton& skeleton) {
  nlohmann::ordered_json bones = nlohmann::ordered_json::array();
  for (const motion::Bone& bone : skeleton.bones) {
    bones.push_back({{"parent", bone.parent},
                     {"child", bone.child},
                     {"side", SideOf(skeleton.joint_names[static_cast<size_t>(bone.child)])}});
  }
  return bones;
}

// Shape: [frames][joints][3].
nlohmann::ordered_json PosesToJson(const motion::Poses& poses) {
  const auto rounded = [](double metres) { return std::round(metres * 1e4) / 1e4; };
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (int t = 0; t < poses.frame_count(); ++t) {
    nlohmann::ordered_json joints = nlohmann::ordered_json::array();
    for (const motion::Vec3& p : poses[t]) {
      joints.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    }
    frames.push_back(std::move(joints));
  }
  return frames;
}

// The data of a figure: a strip of moments of two stick figures, and an animation. Positions are in
// metres, rounded to 0.1 mm.
nlohmann::ordered_json PosePlot(const std::string& title, const engine::ModelDescription& model,
                                const Poses& leader, const Poses& follower) {
  const int head = model.skeleton.Find("head");
  nlohmann::ordered_json pair = {
      {"name", model.name}, {"leader", PosesToJson(leader)}, {"follower", PosesToJson(follower)}};
  return {{"kind", "poses"},
          {"title", title},
          {"frame_rate_hz", model.frame_rate_hz},
          {"root", model.skeleton.root},
          {"head", head < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(head)},
          {"bones", BonesToJson(model.skeleton)},
          {"pairs", nlohmann::ordered_json::array({std::move(pair)})}};
}

// A row for each answer, so that answers of two programs can be compared one by one.
report::Table EachAnswer(const engine::ModelDescription& model,
                         const std::vector<Answer>& answers) {
  report::Table table = FiguresTable("each answer");
  for (const Answer& answer : answers) {
    const std::string& name = model.classes[static_cast<size_t>(answer.label)];
    table.rows.push_back(
        {absl::StrCat(name, " ", answer.leader->id, " ", answer.seed), answer.figures.values});
  }
  return table;
}

// Pictures of the worst seconds of the worst answers.
void AddPictures(const engine::ModelDescription& model, const std::vector<Answer>& answers,
                 int count, report::ResultSection* section) {
  std::vector<const Answer*> worst;
  for (const Answer& answer : answers) worst.push_back(&answer);
  std::stable_sort(worst.begin(), worst.end(), [](const Answer* a, const Answer* b) {
    return a->worst.faults > b->worst.faults;
  });
  worst.resize(std::min(worst.size(), static_cast<size_t>(count)));
  for (size_t n = 0; n < worst.size(); ++n) {
    const Answer& answer = *worst[n];
    const motion::Clip& leader = answer.leader->pair.leader;
    const int first = answer.worst.first;
    const int frames = std::min(static_cast<int>(kPictureSeconds * leader.frame_rate_hz),
                                leader.frame_count() - first);
    const std::string name = model.classes[static_cast<size_t>(answer.label)];
    const std::string caption =
        absl::StrCat(name, ", leader ", answer.leader->id, " from ",
                     static_cast<int>(first / leader.frame_rate_hz), " s, seed ", answer.seed);
    section->figures.push_back(
        {absl::StrCat(section->id, "_worst_", section->figures.size() + 1),
         absl::StrCat(caption, ": leader blue, follower orange; paler on the left of the body."),
         PosePlot(caption, model, motion::Part(leader.poses, first, frames),
                  motion::Part(answer.follower, first, frames))});
  }
}

// The leaders' first poses, held.
std::vector<dataset::Sequence> HoldFirstPoses(const std::vector<dataset::Sequence>& leaders,
                                              double seconds, double frame_rate_hz) {
  std::vector<dataset::Sequence> held;
  for (const dataset::Sequence& leader : leaders) {
    dataset::Sequence& still = held.emplace_back();
    still.id = leader.id;
    const motion::Clip& moving = leader.pair.leader;
    motion::Clip& clip = still.pair.leader;
    clip.joint_names = moving.joint_names;
    clip.frame_rate_hz = frame_rate_hz;
    for (int t = 0; t < seconds * frame_rate_hz; ++t) clip.Append(moving.poses[0]);
  }
  return held;
}

// The figures of stillness of a follower.
std::vector<double> StillnessOf(const motion::Skeleton& skeleton, const Poses& follower,
                                double rate) {
  const body::Body body = body::FindBody(skeleton);
  const auto from = [&](double seconds) {  // a negative number: from the end
    const int frames = follower.frame_count(), at = static_cast<int>(seconds * rate);
    const int first = std::clamp(at < 0 ? frames + at : at, 0, frames - 1);
    return motion::Part(follower, first, frames - first);
  };
  const body::StillnessFigures figures =
      body::MeasureStillness(skeleton, body, from(kSettlingSeconds), rate);
  return {figures.joint_speed, figures.hand_over_shoulder, figures.feet_apart,
          body::MeasureBuild(skeleton, body, from(-kLastSeconds)).hips_over_leg};
}

// Followers of leaders who do not move: without a class and with each, in clips and live.
absl::StatusOr<report::Table> StillnessTable(const PlausibleArguments& arguments,
                                             const std::string& name,
                                             const engine::Synthesizer& synthesizer,
                                             const std::vector<dataset::Sequence>& leaders) {
  const engine::ModelDescription& model = synthesizer.description();
  const double seconds = std::min(arguments.seconds, kStillSeconds);
  const std::vector<dataset::Sequence> held = HoldFirstPoses(leaders, seconds, model.frame_rate_hz);
  report::Table table{
      absl::StrCat(name, ": followers of ", held.size(), " leaders who do not move"),
      {"speed", "hand up", "feet apart", "hips"}};
  for (const bool live : {false, true}) {
    if (live && !engine::AnswersLive(model)) break;
    experiments::AskedSamples asked = arguments.asked;
    asked.live_delay = live ? std::optional(arguments.asked.live_delay.value_or(0)) : std::nullopt;
    for (int c = -1; c < model.class_count(); ++c) {
      const std::vector<float> weights = c < 0 ? std::vector<float>(model.classes.size())
                                               : experiments::OneClass(model.class_count(), c);
      std::vector<experiments::LabelledLeader> labelled;
      for (const dataset::Sequence& leader : held) {
        labelled.push_back(Ask(leader, engine::LabelTrack(weights), asked,
                               SeedOf(model, asked.seed + labelled.size() * 1000)));
      }
      DUET_TRY(auto followers,
               SynthesizeSequences(synthesizer, labelled, experiments::StartGiven::kNone));
      const std::string row = absl::StrCat(
          c < 0 ? "weights 0" : model.classes[static_cast<size_t>(c)], live ? ", live" : "");
      std::vector<std::vector<double>> figures;
      for (size_t i = 0; i < followers.size(); ++i) {
        figures.push_back(StillnessOf(model.skeleton, followers[i], model.frame_rate_hz));
        if (arguments.each) {
          table.rows.push_back({absl::StrCat(row, ", ", held[i].id), figures.back()});
        }
      }
      table.rows.push_back({row, report::ColumnMeans(figures)});
    }
  }
  table.decimals = 3;
  table.notes = {
      absl::StrCat("Each leader's first pose, held for ", seconds, " s. After the first ",
                   kSettlingSeconds,
                   " s: speed of the joints, m/s; share of frames with a hand above its shoulder; "
                   "distance of the feet along the floor, 90 % quantile, metres."),
      absl::StrCat("Hips: mean height above the lower foot in the last ", kLastSeconds,
                   " s, in lengths of the leg.")};
  return table;
}

absl::Status AddModel(const PlausibleArguments& arguments, const std::string& name,
                      const engine::Synthesizer& synthesizer, report::ResultSection* section) {
  const engine::ModelDescription& model = synthesizer.description();
  const experiments::Plausibility plausibility(model.skeleton);
  if (!plausibility.possible()) {
    return absl::InvalidArgumentError(
        absl::StrCat(name,
                     ": expected a skeleton with hips, feet, a chest and two arms whose "
                     "joints are named left and right"));
  }
  DUET_TRY(std::vector<dataset::Sequence> leaders, ReadLeaders(arguments, model.skeleton));
  if (leaders.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("--leaders: expected a folder with motion files, got ", arguments.leaders));
  }
  if (model.skeleton.joint_names == motion::SbuSkeleton().joint_names) {
    for (const char* const made : authoring::kMadeLeaders) {
      dataset::Sequence& leader = leaders.emplace_back();
      leader.id = made;
      leader.pair.leader = {model.skeleton.joint_names, model.frame_rate_hz,
                            authoring::MakeLeader(made, arguments.seconds, model.frame_rate_hz)};
    }
  }
  std::vector<Answer> answers;
  for (int c = 0; c < model.class_count(); ++c) {
    for (int n = 0; n < arguments.asked.samples; ++n) {
      DUET_RETURN_IF_ERROR(
          AddAnswers(arguments, synthesizer, leaders, c, n, plausibility, &answers));
    }
  }
  std::vector<std::vector<experiments::PairFigures>> by_class(model.classes.size());
  for (const Answer& answer : answers) {
    by_class[static_cast<size_t>(answer.label)].push_back(answer.figures);
  }
  section->tables.push_back(FiguresTable(
      absl::StrCat(name, ": followers of ", leaders.size(), " leaders"), model.classes, by_class));
  if (arguments.still) {
    DUET_TRY(report::Table stillness, StillnessTable(arguments, name, synthesizer, leaders));
    section->tables.push_back(std::move(stillness));
  }
  if (arguments.each) section->tables.push_back(EachAnswer(model, answers));
  AddPictures(model, answers, arguments.worst, section);
  return absl::OkStatus();
}

// The same figures for captured pairs.
absl::Status AddCaptured(const std::string& folder, report::ResultSection* section) {
  DUET_TRY(dataset::Dataset data, dataset::ReadDataset(folder));
  const experiments::Plausibility plausibility(data.skeleton);
  if (!plausibility.possible()) {
    return absl::InvalidArgumentError(
        "--data: expected a skeleton with hips, feet, a chest and two named arms");
  }
  std::vector<std::vector<experiments::PairFigures>> by_class(data.classes.size());
  for (const dataset::Sequence& sequence : data.sequences) {
    const motion::ClipPair& pair = sequence.pair;
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(plausibility.Measure(
        pair.leader.poses, pair.follower.poses, pair.leader.frame_rate_hz, {}));
  }
  section->tables.push_back(
      FiguresTable(absl::StrCat("captured people: ", DescribeData(data)), data.classes, by_class));
  return absl::OkStatus();
}

absl::Status RunPlausible(const PlausibleArguments& arguments) {
  DUET_TRY(std::vector<FoldModel> models, OpenModels(arguments.models));
  report::ResultSection section = BeginSection(
      arguments.section,
      "What a viewer would notice in followers of leaders that the model never saw: "
      "every motion file below a folder and, for the skeleton of SBU, four that "
      "formulas make, answered in every class at weight 1 without a start; and their first "
      "poses, held, answered also without a class.");
  section.settings.emplace_back("seeds", absl::StrCat(arguments.asked.samples));
  AddSamplingSettings(arguments.asked, &section);
  for (const FoldModel& model : models) {
    DUET_TRY(SharedSynthesizer synthesizer, model.load(""));
    DUET_RETURN_IF_ERROR(AddModel(arguments, model.name, *synthesizer, &section));
  }
  if (!arguments.data.empty()) {
    DUET_RETURN_IF_ERROR(AddCaptured(arguments.data, &section));
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddPlausibleCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("plausible", "What a viewer would notice in followers of any leaders",
                 RunPlausible, app, chosen);
  arguments->models.as_served = true;
  arguments->asked.samples = 1;
  AddSectionFlags(&arguments->section, command);
  command->add_option("--leaders", arguments->leaders, "folder of motion files, with subfolders")
      ->type_name(kData)
      ->check(CLI::ExistingDirectory)
      ->required();
  AddNumber("--seconds", &arguments->seconds, 1.0, 600.0, "longest leader; longer ones are cut",
            command);
  command
      ->add_option("--data", arguments->data,
                   "captured pairs with the same figures, for comparison")
      ->type_name(kData)
      ->check(CLI::ExistingDirectory);
  AddNumber("--worst", &arguments->worst, 0, 100,
            "answers to picture: the worst seconds of so many of the worst (with --out)", command);
  AddNumber("--samples", &arguments->asked.samples, 1, 1000,
            "answers to each leader, each with its seed", command);
  command->add_flag("--each", arguments->each, "a row for each answer, too");
  command->add_flag("!--no-still", arguments->still, "leave out leaders who do not move");
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  command->add_flag("!--own", arguments->models.as_served, "measure the network's own answers");
  AddSamplingFlags(&arguments->asked, command);
}

}  // namespace duet::evaluation::program
