#include <algorithm>
#include <cmath>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/dataset/dataset.h"
#include "model/dataset/table.h"
#include "model/motion/resample.h"

namespace duet::dataset {
namespace {

constexpr char kSource[] = "labels.tsv";
constexpr double kMostSeconds = 1e6;

absl::StatusOr<int> ParseFrame(const TableRow& row, const char* column, double frame_rate_hz) {
  double seconds = 0;
  if (absl::SimpleAtod(row[column], &seconds) && seconds >= 0 && seconds <= kMostSeconds) {
    return static_cast<int>(std::lround(seconds * frame_rate_hz));
  }
  return base::ErrorAt(kSource, row.line,
                       absl::StrCat(column, ": expected seconds from 0 to ", kMostSeconds, ", got ",
                                    base::Quoted(row[column])));
}

absl::StatusOr<LabelSpan> ParseSpan(const TableRow& row, const std::vector<std::string>& classes,
                                    double frame_rate_hz) {
  const auto found = std::find(classes.begin(), classes.end(), row["class"]);
  if (found == classes.end()) {
    return base::ErrorAt(kSource, row.line,
                         absl::StrCat("class: expected one of ", absl::StrJoin(classes, ", "),
                                      ", got ", base::Quoted(row["class"])));
  }
  DUET_TRY(const int begin, ParseFrame(row, "from_seconds", frame_rate_hz));
  DUET_TRY(const int end, ParseFrame(row, "to_seconds", frame_rate_hz));
  if (end > begin) return LabelSpan{static_cast<int>(found - classes.begin()), begin, end};
  return base::ErrorAt(kSource, row.line,
                       absl::StrCat("to_seconds: expected at least one frame after from_seconds ",
                                    row["from_seconds"], ", got ", row["to_seconds"]));
}

// The window of `frames` frames from `begin` on.
Sequence Window(const Sequence& sequence, int begin, int frames) {
  Sequence window = sequence;
  window.id = absl::StrCat(sequence.id, "#", begin);
  for (motion::Clip* clip : {&window.pair.leader, &window.pair.follower}) {
    clip->poses = motion::Part(clip->poses, begin, frames);
  }
  window.labels.clear();
  for (const LabelSpan& span : sequence.labels) {
    const int first = std::max(span.begin - begin, 0), end = std::min(span.end - begin, frames);
    if (first < end) window.labels.push_back({span.interaction_class, first, end});
  }
  if (!sequence.labels.empty()) window.interaction_class = LongestClass(window.labels);
  return window;
}

}  // namespace

absl::StatusOr<std::map<std::string, std::vector<LabelSpan>>> ParseTimeLines(
    absl::string_view text, const std::vector<std::string>& classes, double frame_rate_hz) {
  DUET_TRY(const std::vector<TableRow> rows,
           ReadTable(text, kSource, {"path", "class", "from_seconds", "to_seconds"}));
  std::map<std::string, std::vector<LabelSpan>> time_lines;
  for (const TableRow& row : rows) {
    DUET_TRY(const LabelSpan span, ParseSpan(row, classes, frame_rate_hz));
    time_lines[row["path"]].push_back(span);
  }
  for (auto& [path, spans] : time_lines) {
    std::stable_sort(spans.begin(), spans.end(),
                     [](const LabelSpan& a, const LabelSpan& b) { return a.begin < b.begin; });
  }
  return time_lines;
}

int LongestClass(const std::vector<LabelSpan>& labels) {
  std::map<int, int> frames;
  for (const LabelSpan& span : labels) frames[span.interaction_class] += span.end - span.begin;
  int longest = -1, most = 0;
  for (const auto& [interaction_class, count] : frames) {
    if (count > most) longest = interaction_class;
    most = std::max(most, count);
  }
  return longest;
}

std::vector<Sequence> CutIntoWindows(const Sequence& sequence, int frames, int stride) {
  const int count = sequence.pair.leader.frame_count();
  if (count <= frames) return {sequence};
  std::vector<Sequence> windows;
  for (int begin = 0; begin < count - frames + stride; begin += stride) {
    Sequence window = Window(sequence, std::min(begin, count - frames), frames);
    if (window.interaction_class >= 0) windows.push_back(std::move(window));
  }
  return windows;
}

}  // namespace duet::dataset
