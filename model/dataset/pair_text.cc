#include "model/dataset/pair_text.h"

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/dataset/split_text.h"

namespace duet {
namespace {

constexpr size_t kLongestQuote = 40;

absl::Status ParseNumber(int line, size_t column, std::string_view cell, float* out) {
  const std::string_view number = TrimText(cell);
  const char* end = number.data() + number.size();
  const auto [parsed, error] = std::from_chars(number.data(), end, *out);
  if (error == std::errc() && parsed == end && std::isfinite(*out)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("line ", line, ", column ", column + 1, ": \"",
                                                 std::string(cell.substr(0, kLongestQuote)),
                                                 "\", wanted a finite number"));
}

// Appends one frame of a person; `cells` starts at its first coordinate.
absl::Status AppendPerson(int line, const std::vector<std::string_view>& cells, size_t first,
                          const CoordinateFrame& frame, Clip* clip) {
  for (size_t joint = 0; joint < clip->joint_names.size(); ++joint) {
    float values[3];
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t column = first + 3 * joint + axis;
      absl::Status status = ParseNumber(line, column, cells[column], &values[axis]);
      if (!status.ok()) return status;
    }
    clip->positions.push_back(ToWorld(frame, {values[0], values[1], values[2]}));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<PeoplePair> ParsePairText(std::string_view text, const DatasetLayout& layout) {
  PeoplePair pair;
  pair.left.joint_names = pair.right.joint_names = layout.skeleton.joint_names;
  pair.left.frame_rate_hz = pair.right.frame_rate_hz = layout.frame_rate_hz;
  const size_t person = 3 * layout.skeleton.joint_names.size();
  int line = 0;
  for (std::string_view row : SplitText(text, '\n')) {
    ++line;
    row = TrimText(row);
    if (row.empty()) continue;
    const std::vector<std::string_view> cells = SplitText(row, ',');
    if (cells.size() != 1 + 2 * person) {
      return absl::InvalidArgumentError(absl::StrCat(
          "line ", line, ": ", cells.size(), " values, wanted ", 1 + 2 * person,
          " (a frame number and two people's ", layout.skeleton.joint_count(), " joints)"));
    }
    float frame_number = 0;
    absl::Status status = ParseNumber(line, 0, cells[0], &frame_number);
    if (status.ok()) status = AppendPerson(line, cells, 1, layout.frame, &pair.left);
    if (status.ok()) status = AppendPerson(line, cells, 1 + person, layout.frame, &pair.right);
    if (!status.ok()) return status;
  }
  if (pair.left.frame_count() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("line ", line, ": ", pair.left.frame_count(), " frames, wanted at least 2"));
  }
  return pair;
}

}  // namespace duet
