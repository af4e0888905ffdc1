#include "model/dataset/leader_side.h"

#include <algorithm>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"

namespace duet::dataset {
namespace {

// The places of the columns; -1: none.
struct Columns {
  int path = -1, leader_side = -1, subjects = -1, source = -1, group = -1;
  size_t count = 0;
};

absl::Status Wrong(int line, const std::string& expected, const std::string& got) {
  return absl::InvalidArgumentError(
      absl::StrCat("index.tsv: line ", line, ": expected ", expected, ", got ", got));
}

absl::StatusOr<Columns> ParseHeader(absl::string_view line) {
  Columns columns;
  const std::vector<absl::string_view> names = absl::StrSplit(line, '\t');
  columns.count = names.size();
  const std::pair<absl::string_view, int*> known[] = {{"path", &columns.path},
                                                      {"leader_side", &columns.leader_side},
                                                      {"subjects", &columns.subjects},
                                                      {"leader_source", &columns.source},
                                                      {"group", &columns.group}};
  for (size_t i = 0; i < names.size(); ++i) {
    for (const auto& [name, column] : known) {
      if (names[i] == name) *column = static_cast<int>(i);
    }
  }
  if (columns.path < 0 || columns.leader_side < 0) {
    return Wrong(1, "a header of tab-separated names with path and leader_side", "others");
  }
  return columns;
}

absl::StatusOr<LeaderSide> ParseSide(int line, absl::string_view text) {
  if (text == "left") return LeaderSide::kLeft;
  if (text == "right") return LeaderSide::kRight;
  if (text == "unknown") return LeaderSide::kUnknown;
  return Wrong(line, "leader_side left, right or unknown", base::Quoted(text));
}

std::vector<std::string> ParseSubjects(absl::string_view text) {
  std::vector<std::string> subjects;
  for (absl::string_view subject : absl::StrSplit(text, ',')) {
    subject = absl::StripAsciiWhitespace(subject);
    if (!subject.empty()) subjects.emplace_back(subject);
  }
  return subjects;
}

}  // namespace

bool LooksLikeIndex(absl::string_view text) {
  return ParseHeader(absl::StripSuffix(text.substr(0, text.find('\n')), "\r")).ok();
}

absl::StatusOr<std::map<std::string, IndexEntry>> ParseIndex(absl::string_view text) {
  std::map<std::string, IndexEntry> entries;
  Columns columns;
  int line = 0;
  for (absl::string_view row : absl::StrSplit(text, '\n')) {
    ++line;
    row = absl::StripSuffix(row, "\r");
    if (line == 1) {
      DUET_TRY(columns, ParseHeader(row));
      continue;
    }
    if (row.empty()) continue;
    const std::vector<absl::string_view> cells = absl::StrSplit(row, '\t');
    if (cells.size() != columns.count) {
      return Wrong(line, absl::StrCat(columns.count, " columns"), absl::StrCat(cells.size()));
    }
    IndexEntry entry;
    entry.line = line;
    const auto cell = [&](int column) {
      return column < 0 ? absl::string_view() : cells[static_cast<size_t>(column)];
    };
    DUET_TRY(entry.leader_side, ParseSide(line, cell(columns.leader_side)));
    entry.subjects = ParseSubjects(cell(columns.subjects));
    entry.guessed = absl::StartsWith(cell(columns.source), "guess");
    entry.group = std::string(cell(columns.group));
    const std::string path(cell(columns.path));
    if (!entries.emplace(path, std::move(entry)).second) {
      return Wrong(line, "each path once", absl::StrCat(base::Quoted(path), " again"));
    }
  }
  return entries;
}

float PeakDisplacement(const motion::Clip& clip, int root, const std::vector<int>& effectors) {
  float peak = 0;
  for (const int effector : effectors) {
    const motion::Vec3 start = clip.at(0, effector) - clip.at(0, root);
    for (int t = 1; t < clip.frame_count(); ++t) {
      peak = std::max(peak, Distance(clip.at(t, effector) - clip.at(t, root), start));
    }
  }
  return peak;
}

LeaderSide LeaderByMotion(const motion::Clip& left, const motion::Clip& right, int root,
                          const std::vector<int>& effectors) {
  return PeakDisplacement(right, root, effectors) > PeakDisplacement(left, root, effectors)
             ? LeaderSide::kRight
             : LeaderSide::kLeft;
}

}  // namespace duet::dataset
