#ifndef DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::formats::flat {

// What stands in a column.
struct CsvColumn {
  enum class Kind {
    kPassedOver,  // a frame number, an index
    kPosition,    // one axis of a joint's position
    kTime,        // seconds
    kFrame,       // which frame a row belongs to   } of a file
    kPerson,      // whose joint a row belongs to   } with a row for each joint
    kJoint,       // which joint a row belongs to   }
  };
  Kind kind = Kind::kPassedOver;
  int person = 0;  // kPosition
  int joint = 0;   // kPosition: into the person's joints
  int axis = 0;    // kPosition: 0 x, 1 y, 2 z
};

// The columns of a file: a row for each frame, or for each joint of each frame.
struct CsvHeader {
  std::vector<CsvColumn> columns;
  std::vector<std::vector<std::string>> joint_names;  // [people]; empty with a row for each joint
  bool row_for_each_joint = false;
};

// The fields of a row, without blanks and quotes around them; they last as long as the line. A
// quoted field may hold delimiters.
using CsvRow = std::vector<absl::string_view>;
CsvRow SplitRow(absl::string_view line, char delimiter);

// The first of comma, semicolon and tab that a header line has; a comma where it has none.
char FindDelimiter(absl::string_view line);

// How many of the first rows name the columns: 1 (`head_x`); with columns of several levels 2
// (`head` over `x`) or 3 (`leader` over `head` over `x`). `rows` holds at most the first three.
std::size_t CountHeaderRows(const std::vector<CsvRow>& rows);

// What a row below several header rows says of the first column, where it is the name of that
// index (`frame`, `time`) and nothing else.
std::optional<CsvColumn::Kind> ReadIndexName(const CsvRow& row);

// `rows`: the header's, each of as many fields.
// Errors: INVALID_ARGUMENT "column 4: came ..., wanted ..." or what is missing.
absl::StatusOr<CsvHeader> ReadHeader(const std::vector<CsvRow>& rows);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_
