#include "model/evaluation/experiments/long_clips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/median.h"
#include "model/body/liveliness.h"
#include "model/body/posture.h"
#include "model/motion/feet.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kEndSeconds = 10, kHourEndSeconds = 60;

// The frames of the beginning and of the end of a follower.
int EndFrames(const motion::Poses& follower, double seconds, double frame_rate_hz) {
  return std::min(follower.frame_count(), static_cast<int>(std::lround(seconds * frame_rate_hz)));
}

// Of the two roots along the floor, in each frame.
std::vector<double> Distances(const motion::Skeleton& skeleton, const motion::Poses& leader,
                              const motion::Poses& follower) {
  std::vector<double> distances;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    distances.push_back(std::hypot(apart.x, apart.z));
  }
  return distances;
}

// The columns of the tables.
struct Column {
  const char* name;
  double LongClipFigures::*figure;
  bool smallest = false;  // is the worst
};
constexpr Column kColumns[] = {{"trunk lean", &LongClipFigures::trunk_lean},
                               {"body lean", &LongClipFigures::body_lean},
                               {"feet above", &LongClipFigures::feet_above},
                               {"feet below", &LongClipFigures::feet_below},
                               {"farthest", &LongClipFigures::farthest},
                               {"last lean", &LongClipFigures::last_lean},
                               {"last feet", &LongClipFigures::last_feet},
                               {"first speed", &LongClipFigures::first_speed, true},
                               {"last speed", &LongClipFigures::last_speed, true}};

using Groups = report::Groups<LongClipRow>;

report::Table LeanTable(const std::string& title, const std::vector<std::string>& classes,
                        const Groups& groups) {
  report::Table table{title, classes};
  table.decimals = 1;
  for (const auto& [name, rows] : groups) {
    std::vector<double> leans(classes.size(), NAN);
    for (const LongClipRow& row : rows) {
      double& worst = leans[static_cast<size_t>(row.interaction_class)];
      worst = std::fmax(worst, std::fmax(row.figures.trunk_lean, row.figures.body_lean));
    }
    table.rows.push_back({name, std::move(leans)});
  }
  table.notes = {
      "The larger one of hips to neck and feet to neck against the vertical, each the largest mean "
      "over one second."};
  return table;
}

report::Table WorstTable(const std::string& title, const Groups& groups) {
  report::Table table{title};
  for (const Column& column : kColumns) table.columns.push_back(column.name);
  for (const auto& [name, rows] : groups) {
    const LongClipFigures worst = Worst(rows);
    report::TableRow& row = table.rows.emplace_back(report::TableRow{name, {}});
    for (const Column& column : kColumns) row.values.push_back(worst.*column.figure);
  }
  table.notes = {
      "Leans: degrees. Feet: how far the lower foot gets from the leader's floor, metres. "
      "Farthest: distance to the leader, metres. Over the last ten seconds: the larger lean's "
      "mean, and the lower foot's mean distance from the floor. Speeds of the joints over the "
      "first and the last ten seconds, without noise, m/s."};
  return table;
}

}  // namespace

LongClipFigures MeasureLongClip(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz) {
  const double floor =
      skeleton.feet ? double{base::Median(motion::LowerFoot(*skeleton.feet, leader))} : 0;
  const motion::Poses calm = motion::WithoutNoise(follower, frame_rate_hz);
  const int part = EndFrames(follower, kEndSeconds, frame_rate_hz);
  const int last = follower.frame_count() - part;
  const motion::Poses end = motion::Part(follower, last, part);
  const auto lean = [&](const motion::Poses& poses, body::LeanFrom from) {
    return body::MeasureLean(poses, skeleton, frame_rate_hz, from);
  };
  const std::vector<double> distances = Distances(skeleton, leader, follower);
  const body::FloorGap gap = body::MeasureFloorGap(follower, skeleton, floor);
  LongClipFigures figures;
  figures.trunk_lean = lean(follower, body::LeanFrom::kHips).max_degrees;
  figures.body_lean = lean(follower, body::LeanFrom::kFeet).max_degrees;
  figures.feet_above = gap.above;
  figures.feet_below = gap.below;
  figures.farthest = *std::max_element(distances.begin(), distances.end());
  figures.first_speed = body::JointSpeed(motion::Part(calm, 0, part), frame_rate_hz);
  figures.last_speed = body::JointSpeed(motion::Part(calm, last, part), frame_rate_hz);
  figures.last_lean = std::fmax(lean(end, body::LeanFrom::kHips).mean_degrees,
                                lean(end, body::LeanFrom::kFeet).mean_degrees);
  figures.last_feet = body::MeasureFloorGap(end, skeleton, floor).mean;
  return figures;
}

LongClipFigures Worst(const std::vector<LongClipRow>& rows) {
  LongClipFigures worst = rows.front().figures;
  for (const LongClipRow& row : rows) {
    for (const Column& column : kColumns) {
      const double before = worst.*column.figure, now = row.figures.*column.figure;
      worst.*column.figure = column.smallest ? std::fmin(before, now) : std::fmax(before, now);
    }
  }
  return worst;
}

std::vector<report::Table> LongTables(const std::string& what,
                                      const std::vector<std::string>& classes,
                                      const std::vector<LongClipRow>& rows) {
  const Groups leaders = report::GroupBy(
      rows, [](const LongClipRow& row) { return absl::StrCat(row.model, ": ", row.leader); });
  const Groups by_class = report::GroupBy(rows, [&](const LongClipRow& row) {
    return absl::StrCat(row.model, ": ", classes[static_cast<size_t>(row.interaction_class)]);
  });
  return {LeanTable(absl::StrCat("Largest lean, degrees, ", what), classes, leaders),
          WorstTable(absl::StrCat("Worst class of each leader, ", what), leaders),
          WorstTable(absl::StrCat("Worst leader of each class, ", what), by_class)};
}

LiveHourFigures MeasureLiveHour(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz) {
  const int part = EndFrames(follower, kHourEndSeconds, frame_rate_hz);
  const auto speed = [&](int first) {
    const motion::Poses end = motion::Part(follower, first, part);
    return body::JointSpeed(motion::WithoutNoise(end, frame_rate_hz), frame_rate_hz);
  };
  int outside = 0, run = 0, longest = 0;
  const std::vector<double> distances = Distances(skeleton, leader, follower);
  for (const double distance : distances) {
    const bool is_outside = distance < kNearestWanted || distance > kFarthestWanted;
    run = is_outside ? run + 1 : 0;
    longest = std::max(longest, run);
    outside += is_outside ? 1 : 0;
  }
  const body::FloorGap gap = body::MeasureFloorGap(follower, skeleton, /*floor=*/0);
  LiveHourFigures figures;
  figures.trunk_lean =
      body::MeasureLean(follower, skeleton, frame_rate_hz, body::LeanFrom::kHips).max_degrees;
  figures.nearest = *std::min_element(distances.begin(), distances.end());
  figures.farthest = *std::max_element(distances.begin(), distances.end());
  figures.out_of_range = static_cast<double>(outside) / follower.frame_count();
  figures.longest_outside = longest / frame_rate_hz;
  figures.feet = std::fmax(gap.above, gap.below);
  figures.first_speed = speed(0);
  figures.last_speed = speed(follower.frame_count() - part);
  return figures;
}

}  // namespace duet::evaluation::experiments
