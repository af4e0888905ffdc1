#include "model/dataset/leader_side.h"

#include <algorithm>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/dataset/table.h"

namespace duet::dataset {

absl::StatusOr<std::map<std::string, IndexEntry>> ParseIndex(absl::string_view text) {
  const std::map<std::string, LeaderSide> sides = {{"left", LeaderSide::kLeft},
                                                   {"right", LeaderSide::kRight},
                                                   {"unknown", LeaderSide::kUnknown}};
  DUET_TRY(const std::vector<TableRow> rows, ReadTable(text, "index.tsv", {"path", "leader_side"}));
  std::map<std::string, IndexEntry> entries;
  for (const TableRow& row : rows) {
    const auto side = sides.find(row["leader_side"]);
    if (side == sides.end()) {
      return base::ErrorAt("index.tsv", row.line,
                           absl::StrCat("leader_side: expected left, right or unknown, got ",
                                        base::Quoted(row["leader_side"])));
    }
    IndexEntry entry = {side->second, row.Names("subjects"),
                        absl::StartsWith(row["leader_source"], "guess"), row.line};
    if (!entries.emplace(row["path"], std::move(entry)).second) {
      return base::ErrorAt(
          "index.tsv", row.line,
          absl::StrCat("path: expected each once, got ", base::Quoted(row["path"]), " again"));
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
