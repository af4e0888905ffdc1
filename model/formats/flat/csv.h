#ifndef DUET_MODEL_FORMATS_FLAT_CSV_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/recorded_motion.h"

namespace duet::formats::flat {

// Positions by column, one row per frame, for scripts and spreadsheets:
//
//   # duet motion: frame_rate_hz=30 unit=metres up_axis=y-up
//   frame,leader.head_x,leader.head_y,leader.head_z,...,follower.head_x,...
//   0,0.01,1.62,-0.3,...
//
// A file of one person has columns without `leader.` and `follower.`. Comment lines start with '#';
// of their words, only frame_rate_hz (or fps), unit and up_axis (motion/coordinates.h) are read.
// Columns may be in any order; columns of an index or of times are ignored. The reader also accepts
// other separators of joint and axis (head.x, headX, head_loc_x), and what spreadsheets write:
// semicolons or tabs, "sep=;", decimal commas.
//
// Errors: INVALID_ARGUMENT "source:line: column 4: expected ..., got ...".
absl::StatusOr<motion::RecordedMotion> ParseCsv(absl::string_view text, absl::string_view source);

// Writes metres, y up. Requires one person, or a leader and a follower, whom CheckPeople accepts.
std::string FormatCsv(const std::vector<motion::Clip>& people);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_H_
