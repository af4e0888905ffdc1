#include "model/evaluation/report/clean_up_table.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "model/cleanup/clean_up.h"
#include "model/evaluation/metrics/motion_quality.h"
#include "model/evaluation/metrics/penetration.h"

namespace duet::evaluation::report {
namespace {

constexpr float kCentimetres = 100;
constexpr float kMovedMetres = 0.01f;
constexpr double kHigh = 0.99;

cleanup::Options NoStage() {
  cleanup::Options none;
  none.upright.enabled = none.spacing.enabled = none.capsules.enabled = false;
  none.waist.enabled = none.hand_contact.enabled = none.floor.enabled = none.footsteps.enabled =
      none.joint_ranges.enabled = false;
  none.shoulders.enabled = none.limb_swings.enabled = false;
  return none;
}

template <typename Stage>
cleanup::Options Only(Stage cleanup::Options::*stage) {
  cleanup::Options only = NoStage();
  (only.*stage).enabled = true;
  return only;
}

std::vector<std::pair<std::string, cleanup::Options>> Variants() {
  return {{"captured", NoStage()},
          {"shoulders", Only(&cleanup::Options::shoulders)},
          {"waist", Only(&cleanup::Options::waist)},
          {"upright", Only(&cleanup::Options::upright)},
          {"spacing", Only(&cleanup::Options::spacing)},
          {"capsules", Only(&cleanup::Options::capsules)},
          {"floor", Only(&cleanup::Options::floor)},
          {"footsteps", Only(&cleanup::Options::footsteps)},
          {"joint ranges", Only(&cleanup::Options::joint_ranges)},
          {"limb swings", Only(&cleanup::Options::limb_swings)},
          {"all", {}}};
}

// A row's sums over sequences.
struct Effect {
  std::vector<float> ways;  // of every joint in every frame, metres
  int frames = 0, moved_frames = 0;
  double slide = 0, depth = 0;
};

void Add(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
         const cleanup::CleanUp& clean_up, Effect* effect) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  const motion::Poses& captured = sequence.pair.follower.poses;
  const bool touches = dataset.touches[static_cast<std::size_t>(sequence.interaction_class)];
  const cleanup::Touch touch(static_cast<std::size_t>(leader.frame_count()), touches ? 1.0f : 0.0f);
  motion::Poses cleaned = captured;
  clean_up.Apply(leader, touch, cleanup::Meetings(touch.size()), {dataset.frame_rate_hz, 0},
                 &cleaned);
  for (int t = 0; t < captured.frame_count(); ++t) {
    float farthest = 0;
    for (int j = 0; j < captured.joint_count(); ++j) {
      effect->ways.push_back(Distance(captured.at(t, j), cleaned.at(t, j)));
      farthest = std::max(farthest, effect->ways.back());
    }
    ++effect->frames;
    if (farthest > kMovedMetres) ++effect->moved_frames;
  }
  effect->slide += metrics::MeasureFootSlide(cleaned, dataset.skeleton, dataset.frame_rate_hz)
                       .centimetres_a_frame;
  effect->depth += metrics::MeasurePenetration(leader, cleaned, dataset.skeleton, dataset.parts)
                       .max_depth_metres;
}

double Mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

float High(std::vector<float> values) {
  const auto at = static_cast<std::ptrdiff_t>(kHigh * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

Table CleanUpTable(const dataset::Dataset& dataset) {
  Table table;
  table.title = "What clean-up does to captured followers";
  table.columns = {"frames moved %", "way cm", "way cm 99 %", "slide cm a frame", "depth cm"};
  table.notes = {
      "Each stage alone, then all. Frames moved: some joint moves more than a centimetre. Way: of "
      "a joint in a frame, mean and 99th percentile. Depth: the deepest overlap with the leader."};
  if (dataset.sequences.empty()) return table;
  const double sequences = static_cast<double>(dataset.sequences.size());
  for (const auto& [name, options] : Variants()) {
    const cleanup::CleanUp clean_up(dataset.skeleton, options);
    Effect effect;
    for (const dataset::Sequence& sequence : dataset.sequences) {
      Add(dataset, sequence, clean_up, &effect);
    }
    table.rows.push_back({name,
                          {100.0 * effect.moved_frames / effect.frames,
                           kCentimetres * Mean(effect.ways), kCentimetres * High(effect.ways),
                           effect.slide / sequences, kCentimetres * effect.depth / sequences}});
  }
  return table;
}

}  // namespace duet::evaluation::report
