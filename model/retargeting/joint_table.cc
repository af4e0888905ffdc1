#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {

absl::StatusOr<JointOverrides> ParseJointTable(absl::string_view text, absl::string_view source) {
  JointOverrides table;
  base::LineReader lines(base::SkipByteOrderMark(text));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line[0] == '#') continue;
    const std::pair<absl::string_view, absl::string_view> joints =
        absl::StrSplit(line, absl::MaxSplits('=', 1));
    const absl::string_view target = absl::StripAsciiWhitespace(joints.first);
    const absl::string_view name = absl::StripAsciiWhitespace(joints.second);
    if (target.empty() || name.empty()) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected MODEL_JOINT=FILE_JOINT such as left_hand=LeftWrist, "
                       "got ",
                       base::Quoted(line)));
    }
    if (!table.emplace(target, name).second) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected each joint once, got ", base::Quoted(target), " twice"));
    }
  }
  return table;
}

}  // namespace duet::retargeting
