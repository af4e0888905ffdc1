#ifndef DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::formats::flat {

// The content of a column.
struct CsvColumn {
  enum class Kind {
    kPassedOver,  // an index
    kPosition,    // one axis of a joint's position
    kTime,        // seconds
    kFrame,       // a frame number
    // In a file with a row for each joint:
    kPerson,
    kJoint,
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

// The fields of a row, without surrounding white space and quotes. They point into the line. A
// quoted field may contain delimiters.
using CsvRow = std::vector<absl::string_view>;
CsvRow SplitRow(absl::string_view line, char delimiter);

// The first of comma, semicolon and tab in a header line; a comma if it has none.
char FindDelimiter(absl::string_view line);

// The number of header rows: 1 (`head_x`), or with columns of several levels 2 (`head` over `x`) or
// 3 (`leader` over `head` over `x`). `rows` holds at most the first three.
std::size_t CountHeaderRows(const std::vector<CsvRow>& rows);

// The kind of the first column, if the row below several header rows holds only its name (`frame`,
// `time`).
std::optional<CsvColumn::Kind> ReadIndexName(const CsvRow& row);

// Requires header rows with the same number of fields.
// Errors: INVALID_ARGUMENT "column 4: expected ..., got ..." or "head_x: expected ...".
absl::StatusOr<CsvHeader> ReadHeader(const std::vector<CsvRow>& rows);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_HEADER_H_
