#ifndef DUET_MODEL_DATASET_TABLE_H_
#define DUET_MODEL_DATASET_TABLE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::dataset {

// A line of a tab-separated table.
struct TableRow {
  int line = 0;                              // from 1, for messages
  std::map<std::string, std::string> cells;  // by the names of the columns

  // Empty if the table does not have the column.
  const std::string& operator[](const std::string& column) const;
  // The names in a cell, separated by commas.
  std::vector<std::string> Names(const std::string& column) const;
};

// Reads a table: a header with the names of the columns in any order, then rows with a cell for
// each. Skips empty lines. Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ..." for a
// header without a column of `required`, and for a row with another number of cells.
absl::StatusOr<std::vector<TableRow>> ReadTable(absl::string_view text, absl::string_view source,
                                                const std::vector<std::string>& required);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_TABLE_H_
