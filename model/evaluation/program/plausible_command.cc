#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/authoring/made_leaders.h"
#include "model/base/angle.h"
#include "model/base/split_mix.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/body/build.h"
#include "model/body/contact.h"
#include "model/body/grade.h"
#include "model/body/liveliness.h"
#include "model/body/posture.h"
#include "model/engine/live_synthesis.h"
#include "model/evaluation/program/experiment.h"
#include "model/formats/motion_file.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"
#include "model/retargeting/rig_fitting.h"
#include "model/solver/partner.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;
using motion::Poses;

// A clip counts as twisted from this angle between shoulders and hips on, in any frame.
constexpr double kTwistedClipDegrees = 60;
// A joint that turns faster than this is a fault.
constexpr double kTurnDegreesPerSecond = 900;
// Hands embrace behind the partner's trunk, within this distance of its hips.
constexpr float kEmbraceMetres = 0.5f;
// Leaders who do not move, for measurements of stillness: their length, unless --seconds is less;
// the beginning, in which a follower may still come to rest; and the end.
constexpr double kStillSeconds = 15, kSettlingSeconds = 3, kLastSeconds = 2;

struct PlausibleFlags : ExperimentFlags {
  std::string leaders;
  double seconds = 60;
  bool each = false;  // a row for each answer, too
  bool still = true;  // also leaders who do not move
};

// The fastest turn of a joint of the rig against its parent, degrees per second.
double FastestTurn(const motion::Skeleton& skeleton, const Poses& poses, double rate) {
  const retargeting::RigAnimation animation =
      retargeting::AnimateRig(skeleton, {skeleton.joint_names, rate, poses});
  double fastest = 0;
  for (size_t t = 1; t < animation.frames.size(); ++t) {
    for (size_t j = 0; j < animation.rig.joints.size(); ++j) {
      const double angle =
          Angle(animation.frames[t - 1].rotations[j], animation.frames[t].rotations[j]);
      fastest = std::max(fastest, base::kDegreesPerRadian * angle * rate);
    }
  }
  return fastest;
}

// The files below a folder whose extension formats::ReadLeader reads, sorted. NOT_FOUND if the
// folder, or a folder in it, cannot be listed.
absl::StatusOr<std::vector<fs::path>> MotionFilesBelow(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    if (it->is_regular_file(unknown) && formats::IsReadable(it->path())) {
      files.push_back(it->path());
    }
  }
  if (error) {
    return absl::NotFoundError(
        absl::StrCat(folder.string(), ": cannot be listed: ", error.message()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The motion files below a folder as leaders of a model, in the order of their paths, and for SBU's
// skeleton those that formulas make, each cut to `seconds`. Reports files that cannot be read, and
// leaves them out.
absl::StatusOr<std::vector<dataset::Sequence>> ReadLeaders(const PlausibleFlags& flags,
                                                           const engine::ModelDescription& model) {
  DUET_TRY(const std::vector<fs::path> files, MotionFilesBelow(flags.leaders));
  std::vector<dataset::Sequence> leaders;
  formats::ReadOptions options;
  options.skeleton = model.skeleton;
  for (const fs::path& file : files) {
    absl::StatusOr<motion::Clip> leader = formats::ReadLeader(file, options);
    if (!leader.ok()) {
      std::cerr << absl::StrCat("left out: ", leader.status().message(), "\n");
      continue;
    }
    const int most = static_cast<int>(flags.seconds * leader->frame_rate_hz);
    if (leader->frame_count() > most) leader->poses.Resize(most);
    dataset::Sequence& sequence = leaders.emplace_back();
    sequence.id = file.filename().string();
    sequence.pair.leader = *std::move(leader);
  }
  if (leaders.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("--leaders: expected a folder with motion files, got ", flags.leaders));
  }
  if (model.skeleton.joint_names != motion::SbuSkeleton().joint_names) return leaders;
  for (const char* const made : authoring::kMadeLeaders) {
    dataset::Sequence& sequence = leaders.emplace_back();
    sequence.id = made;
    sequence.pair.leader = {model.skeleton.joint_names, model.frame_rate_hz,
                            authoring::MakeLeader(made, flags.seconds, model.frame_rate_hz)};
  }
  return leaders;
}

// The n-th seed of the answers: one that a server gives callers who name none, if the model has a
// list of them.
uint64_t SeedOf(const engine::ModelDescription& model, uint64_t n) {
  const std::vector<uint64_t>& seeds = model.default_seeds;
  return seeds.empty() ? n : seeds[base::SplitMix(n, 1) % seeds.size()];
}

// The leaders with one label vector. Each has its own seed.
std::vector<LabelledLeader> Label(const std::vector<dataset::Sequence>& leaders,
                                  const std::vector<float>& weights, uint64_t seed,
                                  const engine::ModelDescription& model) {
  std::vector<LabelledLeader> labelled;
  for (const dataset::Sequence& leader : leaders) {
    labelled.push_back({&leader, weights, SeedOf(model, seed + labelled.size() * 1000)});
  }
  return labelled;
}

// The figures of pairs with one class: the mean of each column, the largest of "hips off".
std::vector<double> Combine(const std::vector<std::vector<double>>& pairs) {
  std::vector<double> combined = report::ColumnMeans(pairs);
  const std::vector<std::string>& names = PlausibleFigures();
  const size_t hips_off =
      static_cast<size_t>(std::find(names.begin(), names.end(), "hips off") - names.begin());
  for (const std::vector<double>& pair : pairs) {
    combined[hips_off] = std::max(combined[hips_off], pair[hips_off]);
  }
  return combined;
}

// A row for each class with the figures of its pairs, and their mean. Shapes: pairs [classes].
report::Table FiguresTable(const std::string& title, const std::vector<std::string>& classes,
                           const std::vector<std::vector<std::vector<double>>>& pairs) {
  report::Table table{title, PlausibleFigures()};
  table.decimals = 3;
  std::vector<std::vector<double>> rows;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (pairs[c].empty()) continue;
    rows.push_back(Combine(pairs[c]));
    table.rows.push_back({classes[c], rows.back()});
  }
  table.rows.push_back({"mean", report::ColumnMeans(rows)});
  table.notes = {
      "Twisted clips: share of answers in which shoulders and hips differ by more than 60 degrees "
      "in any frame. Twisted: share of frames above 45 degrees. Both feet: "
      "share of frames in which the slower ankle moves faster than 10 cm/s; leader's: the same of "
      "the leaders.",
      "Heads, trunks: share of frames in which the heads are nearer than 18 cm, the axes of the "
      "trunks nearer than 16 cm. Hands: mean distance of the nearest hands while the leader "
      "reaches one out, metres. Distance: of the roots, metres. Speed: of the joints, m/s.",
      "Turns: share of answers in which a joint of the rig turns faster than 900 degrees a second. "
      "Lean: largest of the trunk over one second, degrees.",
      "Facing: how far hips and shoulders are turned away from the leader, mean over the frames, "
      "degrees.",
      "Hips off: by how much the hips are narrower or wider than their median width, as a share of "
      "it, in the worst frame of all answers. Hips: mean height of the hips above the lower foot, "
      "in lengths of the leg. Knees: mean bend, degrees. Embrace: share of frames in which both "
      "hands are behind the leader's trunk."};
  return table;
}

// The leaders' first poses, held.
std::vector<dataset::Sequence> HoldFirstPoses(const std::vector<dataset::Sequence>& leaders,
                                              double seconds, double frame_rate_hz) {
  std::vector<dataset::Sequence> held;
  for (const dataset::Sequence& leader : leaders) {
    dataset::Sequence& still = held.emplace_back();
    still.id = leader.id;
    motion::Clip& clip = still.pair.leader;
    clip.joint_names = leader.pair.leader.joint_names;
    clip.frame_rate_hz = frame_rate_hz;
    for (int t = 0; t < seconds * frame_rate_hz; ++t) clip.Append(leader.pair.leader.poses[0]);
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
absl::StatusOr<report::Table> StillnessTable(const PlausibleFlags& flags, const std::string& name,
                                             const engine::Synthesizer& synthesizer,
                                             const std::vector<dataset::Sequence>& leaders) {
  const engine::ModelDescription& model = synthesizer.description();
  const double seconds = std::min(flags.seconds, kStillSeconds);
  const std::vector<dataset::Sequence> held = HoldFirstPoses(leaders, seconds, model.frame_rate_hz);
  report::Table table{
      absl::StrCat(name, ": followers of ", held.size(), " leaders who do not move"),
      {"speed", "hand up", "feet apart", "hips"}};
  for (const bool live : {false, true}) {
    if (live && !engine::AnswersLive(model)) break;
    Asked asked = flags.asked;
    asked.live_delay = live ? std::optional(asked.live_delay.value_or(0)) : std::nullopt;
    for (int c = -1; c < model.class_count(); ++c) {
      const std::vector<float> weights =
          c < 0 ? std::vector<float>(model.classes.size()) : OneClass(model.class_count(), c);
      DUET_TRY(const auto followers,
               SynthesizeSequences(synthesizer, Label(held, weights, asked.seed, model), asked));
      const std::string row = absl::StrCat(
          c < 0 ? "weights 0" : model.classes[static_cast<size_t>(c)], live ? ", live" : "");
      std::vector<std::vector<double>> figures;
      for (size_t i = 0; i < followers.size(); ++i) {
        figures.push_back(StillnessOf(model.skeleton, followers[i], model.frame_rate_hz));
        if (flags.each) table.rows.push_back({absl::StrCat(row, ", ", held[i].id), figures[i]});
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

absl::Status CheckSkeleton(const std::string& what, const motion::Skeleton& skeleton) {
  if (body::PairMeter::CanMeasure(skeleton, body::FindBody(skeleton))) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(what,
                   ": expected a skeleton with hips, feet, a chest and two arms whose joints are "
                   "named left and right"));
}

absl::Status AddModel(const PlausibleFlags& flags, const std::string& name,
                      const engine::Synthesizer& synthesizer, report::Section* section) {
  const engine::ModelDescription& model = synthesizer.description();
  DUET_RETURN_IF_ERROR(CheckSkeleton(name, model.skeleton));
  DUET_TRY(const std::vector<dataset::Sequence> leaders, ReadLeaders(flags, model));
  report::Table each{"each answer", PlausibleFigures()};
  each.decimals = 3;
  std::vector<std::vector<std::vector<double>>> by_class(model.classes.size());
  for (size_t c = 0; c < by_class.size(); ++c) {
    const std::vector<float> weights = OneClass(model.class_count(), static_cast<int>(c));
    for (int n = 0; n < flags.asked.samples; ++n) {
      const uint64_t seed = flags.asked.seed + static_cast<uint64_t>(n);
      const std::vector<LabelledLeader> asked = Label(leaders, weights, seed, model);
      DUET_TRY(const auto followers, SynthesizeSequences(synthesizer, asked, flags.asked));
      for (size_t i = 0; i < leaders.size(); ++i) {
        const motion::Clip& leader = leaders[i].pair.leader;
        by_class[c].push_back(
            MeasurePlausibility(model.skeleton, leader.poses, followers[i], leader.frame_rate_hz));
        each.rows.push_back({absl::StrCat(model.classes[c], " ", leaders[i].id, " ", asked[i].seed),
                             by_class[c].back()});
      }
    }
  }
  section->tables.push_back(FiguresTable(
      absl::StrCat(name, ": followers of ", leaders.size(), " leaders"), model.classes, by_class));
  if (flags.still) {
    DUET_TRY(section->tables.emplace_back(), StillnessTable(flags, name, synthesizer, leaders));
  }
  if (flags.each) section->tables.push_back(std::move(each));
  return absl::OkStatus();
}

// The same figures for captured pairs.
absl::Status AddCaptured(const std::string& folder, report::Section* section) {
  DUET_TRY(const dataset::Dataset data, dataset::ReadDataset(folder));
  DUET_RETURN_IF_ERROR(CheckSkeleton("--data", data.skeleton));
  std::vector<std::vector<std::vector<double>>> by_class(data.classes.size());
  for (const dataset::Sequence& sequence : data.sequences) {
    const auto& [leader, follower] = sequence.pair;
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
        MeasurePlausibility(data.skeleton, leader.poses, follower.poses, leader.frame_rate_hz));
  }
  section->tables.push_back(
      FiguresTable(absl::StrCat("captured people: ", DescribeData(data)), data.classes, by_class));
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunPlausible(const PlausibleFlags& flags) {
  DUET_TRY(const std::vector<FoldModel> models, OpenModels(flags));
  report::Section section;
  section.text = {
      "What a viewer would notice in followers of leaders that the model never saw: "
      "every motion file below a folder and, for the skeleton of SBU, four that "
      "formulas make, answered in every class at weight 1 without a start; and their first "
      "poses, held, answered also without a class."};
  for (const FoldModel& model : models) {
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(""));
    DUET_RETURN_IF_ERROR(AddModel(flags, model.name, *synthesizer, &section));
  }
  if (!flags.data.empty()) DUET_RETURN_IF_ERROR(AddCaptured(flags.data, &section));
  return section;
}

// Whether both hands are behind the leader's trunk.
bool Embraces(const motion::Skeleton& skeleton, const body::Body& body,
              absl::Span<const motion::Vec3> leader, absl::Span<const motion::Vec3> follower) {
  const solver::TrunkAxes trunk = solver::TrunkAxesOf(skeleton, body, leader);
  const auto behind = [&](const body::Limb& arm) {
    const motion::Vec3 place = trunk.PlaceOf(follower[static_cast<size_t>(arm.end)]);
    return place.z < 0 && Norm(place) * trunk.length < kEmbraceMetres;
  };
  return !body.arms.empty() && std::all_of(body.arms.begin(), body.arms.end(), behind);
}

}  // namespace

const std::vector<std::string>& PlausibleFigures() {
  static const auto& names = *new std::vector<std::string>{
      "twisted clips", "twisted",  "both feet", "leader's",       "heads",  "trunks",
      "hands",         "distance", "speed",     "leader's speed", "turns",  "lean",
      "facing",        "hips off", "hips",      "knees",          "embrace"};
  return names;
}

std::vector<double> MeasurePlausibility(const motion::Skeleton& skeleton, const Poses& leader,
                                        const Poses& follower, double rate) {
  const body::Body body = body::FindBody(skeleton);
  body::PairMeter meter(skeleton, body, rate);
  body::GradeSum sum;
  double most_twisted = 0, heads = 0, trunks = 0, embraces = 0;
  std::vector<double> hands;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const body::FrameMeasures frame = meter.Add(leader[t], follower[t]);
    sum.Add(frame);
    most_twisted = std::max(most_twisted, frame.twist_degrees);
    heads += frame.head_overlap > 0;
    trunks += frame.trunk_overlap > 0;
    embraces += Embraces(skeleton, body, leader[t], follower[t]);
    const std::optional<double> apart =
        body::OfferedHandDistance(body, skeleton.root, leader[t], follower[t]);
    if (apart) hands.push_back(*apart);
  }
  const body::Grade grade = sum.Get();
  const body::BuildFigures build = body::MeasureBuild(skeleton, body, follower);
  const double frames = leader.frame_count();
  return {most_twisted > kTwistedClipDegrees ? 1.0 : 0.0,
          grade.twisted,
          grade.skating,
          grade.leader_skating,
          heads / frames,
          trunks / frames,
          base::Mean(hands),
          body::RootDistance(leader, follower, skeleton),
          body::JointSpeed(motion::WithoutNoise(follower, rate), rate),
          body::JointSpeed(motion::WithoutNoise(leader, rate), rate),
          FastestTurn(skeleton, follower, rate) > kTurnDegreesPerSecond ? 1.0 : 0.0,
          body::MeasureLean(follower, skeleton, rate, body::LeanFrom::kHips).max_degrees,
          body::FacingDegrees(leader, follower, skeleton),
          build.HipsOff(),
          build.hips_over_leg,
          build.knee_degrees,
          embraces / frames};
}

Measure AddPlausibleCommand(CLI::App* command) {
  const auto flags = std::make_shared<PlausibleFlags>();
  flags->as_served = true;
  AddFolder("--leaders", &flags->leaders, "folder of motion files, with subfolders", command)
      ->check(CLI::ExistingDirectory)
      ->required();
  AddNumber("--seconds", &flags->seconds, 1.0, 600.0, "longest leader; longer ones are cut",
            command);
  AddFolder("--data", &flags->data, "captured pairs with the same figures, for comparison", command)
      ->check(CLI::ExistingDirectory);
  command->add_flag("--each", flags->each, "a row for each answer, too");
  command->add_flag("!--no-still", flags->still, "leave out leaders who do not move");
  AddModelFlags(flags.get(), command);
  command->add_flag("!--own", flags->as_served, "measure the network's own answers");
  AddSamplingFlags(&flags->asked, command);
  return [flags] { return RunPlausible(*flags); };
}

}  // namespace duet::evaluation::program
