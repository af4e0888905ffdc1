#ifndef DUET_MODEL_DATASET_TIME_LINE_H_
#define DUET_MODEL_DATASET_TIME_LINE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/dataset/dataset.h"

namespace duet::dataset {

// Parses labels.tsv: a header with the columns `path`, `class`, `from_seconds` and `to_seconds`,
// then one span per line. Returns the spans by path, sorted by their first frame. A span covers the
// frames from the one nearest to `from_seconds` up to the one nearest to `to_seconds`, exclusive.
// Errors: INVALID_ARGUMENT naming line and column, the expected value and the actual one.
absl::StatusOr<std::map<std::string, std::vector<LabelSpan>>> ParseTimeLines(
    absl::string_view text, const std::vector<std::string>& classes, double frame_rate_hz);

// The class that covers most frames; -1 if no class covers any.
int LongestClass(const std::vector<LabelSpan>& labels);

// Cuts a sequence of more than `frames` frames into windows of `frames` that begin `stride` frames
// apart; the last one ends with the sequence. A window's label is the part of the time line in it.
// Omits windows without a class. A sequence that is not longer is returned unchanged.
std::vector<Sequence> CutIntoWindows(const Sequence& sequence, int frames, int stride);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_TIME_LINE_H_
