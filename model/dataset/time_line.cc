#include <algorithm>
#include <cmath>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/dataset/dataset.h"
#include "model/motion/resample.h"

namespace duet::dataset {
namespace {

constexpr char kHeader[] = "path\tclass\tfrom_seconds\tto_seconds";
constexpr size_t kColumns = 4;
constexpr double kMostSeconds = 1e6;

absl::Status Wrong(int line, absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("labels.tsv: line ", line, ": ", what));
}

absl::StatusOr<int> ParseClass(int line, absl::string_view name,
                               const std::vector<std::string>& classes) {
  const auto found = std::find(classes.begin(), classes.end(), name);
  if (found != classes.end()) return static_cast<int>(found - classes.begin());
  return Wrong(line, absl::StrCat("class: expected one of ", absl::StrJoin(classes, ", "), ", got ",
                                  base::Quoted(name)));
}

absl::StatusOr<int> ParseFrame(int line, const char* column, absl::string_view text,
                               double frame_rate_hz) {
  double seconds = 0;
  if (absl::SimpleAtod(text, &seconds) && seconds >= 0 && seconds <= kMostSeconds) {
    return static_cast<int>(std::lround(seconds * frame_rate_hz));
  }
  return Wrong(line, absl::StrCat(column, ": expected seconds from 0 to ", kMostSeconds, ", got ",
                                  base::Quoted(text)));
}

absl::StatusOr<LabelSpan> ParseSpan(int line, const std::vector<absl::string_view>& cells,
                                    const std::vector<std::string>& classes, double frame_rate_hz) {
  DUET_TRY(const int interaction_class, ParseClass(line, cells[1], classes));
  DUET_TRY(const int begin, ParseFrame(line, "from_seconds", cells[2], frame_rate_hz));
  DUET_TRY(const int end, ParseFrame(line, "to_seconds", cells[3], frame_rate_hz));
  if (end > begin) return LabelSpan{interaction_class, begin, end};
  return Wrong(line, absl::StrCat("to_seconds: expected at least one frame after from_seconds ",
                                  cells[2], ", got ", cells[3]));
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
  std::map<std::string, std::vector<LabelSpan>> time_lines;
  int line = 0;
  for (absl::string_view row : absl::StrSplit(text, '\n')) {
    ++line;
    row = absl::StripSuffix(row, "\r");
    if (line == 1 && row != kHeader) {
      return Wrong(line, absl::StrCat("expected the header path, class, from_seconds, to_seconds, "
                                      "separated by tabs, got ",
                                      base::Quoted(row)));
    }
    if (line == 1 || row.empty()) continue;
    const std::vector<absl::string_view> cells = absl::StrSplit(row, '\t');
    if (cells.size() != kColumns) {
      return Wrong(line, absl::StrCat("expected ", kColumns, " columns, got ", cells.size()));
    }
    DUET_TRY(const LabelSpan span, ParseSpan(line, cells, classes, frame_rate_hz));
    time_lines[std::string(cells[0])].push_back(span);
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
