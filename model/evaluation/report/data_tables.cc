#include "model/evaluation/report/data_tables.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/body/motion_quality.h"
#include "model/body/penetration.h"
#include "model/motion/filter.h"
#include "model/motion/posture.h"
#include "model/solver/follower.h"

namespace duet::evaluation::report {
namespace {

using Sequences = std::vector<const dataset::Sequence*>;

constexpr char kAll[] = "all";
constexpr double kFloorShare = 0.25;
constexpr double kCentimetres = 100;
constexpr double kSmoothingFrames = 1;

// A row's name and its sequences.
struct Group {
  std::string name;
  Sequences sequences;
};

Group Everything(const dataset::Dataset& dataset) {
  Group all = {kAll, {}};
  for (const dataset::Sequence& sequence : dataset.sequences) all.sequences.push_back(&sequence);
  return all;
}

// A data set of one unnamed set has only the row of all.
std::vector<Group> BySet(const dataset::Dataset& dataset) {
  std::map<std::string, Sequences> sets;
  for (const dataset::Sequence& sequence : dataset.sequences) {
    if (!sequence.set.empty()) sets[sequence.set].push_back(&sequence);
  }
  std::vector<Group> groups;
  for (auto& [name, sequences] : sets) groups.push_back({name, std::move(sequences)});
  groups.push_back(Everything(dataset));
  return groups;
}

std::vector<Group> ByClass(const dataset::Dataset& dataset) {
  std::vector<Group> groups;
  for (std::size_t c = 0; c < dataset.classes.size(); ++c) {
    groups.push_back(
        {absl::StrCat(dataset.classes[c], dataset.symmetric[c] ? " (either)" : ""), {}});
  }
  for (const dataset::Sequence& sequence : dataset.sequences) {
    groups[static_cast<std::size_t>(sequence.interaction_class)].sequences.push_back(&sequence);
  }
  groups.push_back(Everything(dataset));
  return groups;
}

enum class World { kCaptured, kLevel };

motion::Poses In(World world, const dataset::Sequence& sequence, const motion::Clip& clip) {
  return world == World::kLevel ? clip.poses : sequence.levelling.Invert(clip.poses);
}

void Append(const std::vector<motion::Vec3>& more, std::vector<motion::Vec3>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

motion::Lean LeanOf(const motion::Skeleton& skeleton, const Sequences& sequences,
                    motion::Clip motion::ClipPair::*person, World world) {
  std::vector<motion::Vec3> directions;
  for (const dataset::Sequence* one : sequences) {
    Append(motion::StandingDirections(skeleton, In(world, *one, one->pair.*person)), &directions);
  }
  return motion::MeanLean(directions);
}

std::vector<motion::Vec3> FeetOf(const motion::Skeleton& skeleton, const Sequences& sequences,
                                 World world) {
  std::vector<motion::Vec3> feet;
  for (const dataset::Sequence* one : sequences) {
    for (const motion::Clip* clip : {&one->pair.leader, &one->pair.follower}) {
      Append(motion::LowerFeet(skeleton, In(world, *one, *clip)), &feet);
    }
  }
  return feet;
}

// A noise row's sums over both people.
struct Noise {
  double joint_frames = 0, repaired = 0;
  double captured = 0, without_jumps = 0, smooth = 0;  // jitter, summed over clips
  int clips = 0;
};

void AddNoise(const motion::Clip& clip, Noise* noise) {
  motion::Poses poses = clip.poses;
  noise->repaired += RepairJumps(&poses);
  noise->joint_frames += poses.frame_count() * poses.joint_count();
  noise->captured += body::Jitter(clip.poses, clip.frame_rate_hz);
  noise->without_jumps += body::Jitter(poses, clip.frame_rate_hz);
  noise->smooth += body::Jitter(GaussianFilter(poses, kSmoothingFrames), clip.frame_rate_hz);
  ++noise->clips;
}

constexpr float kMovedMetres = 0.01f;
constexpr double kHigh = 0.99;

// A row's sums over sequences.
struct Effect {
  std::vector<double> ways;  // of every joint in every frame, metres
  int frames = 0, moved_frames = 0;
  double slide = 0, depth = 0;
};

// The captured follower, solved as an answer of a network would be.
motion::Poses Solved(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                     const solver::FollowerSolver& solver) {
  const motion::Poses& captured = sequence.pair.follower.poses;
  motion::Poses solved = captured;
  const absl::StatusOr<solver::BodyModel> person =
      solver::BodyModel::Measure(dataset.skeleton, captured);
  if (!person.ok() || !solver.CanSolve()) return solved;
  solver::Situation situation{sequence.pair.leader.poses};
  const bool touches = dataset.touches[static_cast<std::size_t>(sequence.interaction_class)];
  situation.rules.assign(static_cast<std::size_t>(captured.frame_count()), {touches ? 1.0f : 0.0f});
  solver.Solve(situation, *person, &solved);
  return solved;
}

void Add(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
         const motion::Poses& cleaned, Effect* effect) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  const motion::Poses& captured = sequence.pair.follower.poses;
  for (int t = 0; t < captured.frame_count(); ++t) {
    float farthest = 0;
    for (int j = 0; j < captured.joint_count(); ++j) {
      const float way = Distance(captured.at(t, j), cleaned.at(t, j));
      effect->ways.push_back(way);
      farthest = std::max(farthest, way);
    }
    ++effect->frames;
    if (farthest > kMovedMetres) ++effect->moved_frames;
  }
  effect->slide +=
      body::MeasureFootSlide(cleaned, dataset.skeleton, dataset.frame_rate_hz).centimetres_a_frame;
  effect->depth +=
      body::MeasurePenetration(leader, cleaned, dataset.skeleton, dataset.parts).max_depth_metres;
}

float High(std::vector<double> values) {
  const auto at = static_cast<std::ptrdiff_t>(kHigh * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return static_cast<float>(values[static_cast<std::size_t>(at)]);
}

}  // namespace

Table LeanTable(const dataset::Dataset& dataset) {
  Table table{"Mean lean of people, degrees: as captured, then level",
              {"sequences", "leader x", "leader z", "follower x", "follower z", "level leader x",
               "level leader z", "level follower x", "level follower z"}};
  table.notes = {
      "From the feet to the neck; x is along the image, z is away from the camera. The lean that "
      "remains in a level set is that of its people."};
  for (const Group& group : BySet(dataset)) {
    TableRow row = {group.name, {static_cast<double>(group.sequences.size())}};
    for (const World world : {World::kCaptured, World::kLevel}) {
      for (const auto person : {&motion::ClipPair::leader, &motion::ClipPair::follower}) {
        const motion::Lean lean = LeanOf(dataset.skeleton, group.sequences, person, world);
        row.values.insert(row.values.end(), {lean.x, lean.z});
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table FloorTable(const dataset::Dataset& dataset) {
  Table table{"The floor under the lower feet: as captured, then level",
              {"lean x", "lean z", "height cm", "level lean x", "level lean z", "level height cm"}};
  table.notes = {
      "The lean of the normal of a plane through the feet, degrees; the height that a "
      "quarter of the feet are below."};
  if (!dataset.skeleton.feet) return table;
  for (const Group& group : BySet(dataset)) {
    TableRow row = {group.name, {}};
    for (const World world : {World::kCaptured, World::kLevel}) {
      const std::vector<motion::Vec3> feet = FeetOf(dataset.skeleton, group.sequences, world);
      const motion::Lean lean = motion::FloorLean(feet);
      row.values.insert(row.values.end(),
                        {lean.x, lean.z, kCentimetres * motion::HeightQuantile(feet, kFloorShare)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table NoiseTable(const dataset::Dataset& dataset) {
  Table table{"Noise of the captures",
              {"joint frames", "repaired", "repaired per mille", "jitter", "jitter repaired",
               "jitter smooth"}};
  table.notes = {
      "Repaired: joints that jump away for a frame and back. Jitter in m/s^3; smooth: repaired, "
      "then filtered by a Gaussian of one frame."};
  for (const Group& group : ByClass(dataset)) {
    Noise noise;
    for (const dataset::Sequence* one : group.sequences) {
      AddNoise(one->pair.leader, &noise);
      AddNoise(one->pair.follower, &noise);
    }
    table.rows.push_back(
        {group.name,
         {noise.joint_frames, noise.repaired, 1000 * (noise.repaired / noise.joint_frames),
          noise.captured / noise.clips, noise.without_jumps / noise.clips,
          noise.smooth / noise.clips}});
  }
  return table;
}

Table LeaderTable(const dataset::Dataset& dataset) {
  Table table{
      "Who leads",
      {"sequences", "by index", "by its guess", "by motion", "rule agrees"},
      {},
      {"Rule agrees: share of the leaders named by the index, other than by its guess, whom the "
       "motion rule names too. Either: a symmetric class, where either person may lead and the "
       "rule is no better than chance."}};
  for (const Group& group : ByClass(dataset)) {
    std::map<std::string, double> sources;
    double asked = 0, agreed = 0;
    for (const dataset::Sequence* one : group.sequences) {
      ++sources[one->leader_source];
      if (one->leader_source != "index" || !one->rule_agrees) continue;
      ++asked;
      if (*one->rule_agrees) ++agreed;
    }
    table.rows.push_back({group.name,
                          {static_cast<double>(group.sequences.size()), sources["index"],
                           sources["guess"], sources["motion"], agreed / asked}});
  }
  return table;
}

Table SolverTable(const dataset::Dataset& dataset) {
  Table table{"What the solver does to captured followers",
              {"frames moved %", "way cm", "way cm 99 %", "slide cm a frame", "depth cm"},
              {},
              {"Frames moved: some joint moves more than a centimetre. Way: of a joint in a frame, "
               "mean and "
               "99th percentile. Depth: the deepest overlap with the leader."}};
  if (dataset.sequences.empty()) return table;
  const double sequences = static_cast<double>(dataset.sequences.size());
  const solver::FollowerSolver solver(dataset.skeleton, dataset.frame_rate_hz);
  for (const bool solves : {false, true}) {
    Effect effect;
    for (const dataset::Sequence& sequence : dataset.sequences) {
      Add(dataset, sequence,
          solves ? Solved(dataset, sequence, solver) : sequence.pair.follower.poses, &effect);
    }
    table.rows.push_back({solves ? "solved" : "captured",
                          {100.0 * effect.moved_frames / effect.frames,
                           kCentimetres * base::Mean(effect.ways), 100.0f * High(effect.ways),
                           effect.slide / sequences, kCentimetres * effect.depth / sequences}});
  }
  return table;
}

}  // namespace duet::evaluation::report
