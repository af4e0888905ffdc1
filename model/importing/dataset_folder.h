#ifndef DUET_MODEL_IMPORTING_DATASET_FOLDER_H_
#define DUET_MODEL_IMPORTING_DATASET_FOLDER_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/dataset/dataset.h"
#include "model/dataset/layout.h"
#include "model/dataset/leader_side.h"
#include "model/importing/capture.h"

namespace duet::importing {

// A sequence to be written to a data set.
struct ImportedSequence {
  Capture capture;  // metres, y up
  dataset::LeaderSide leader_side = dataset::LeaderSide::kUnknown;
  std::string leader_source;
  std::vector<dataset::LabelSpan> labels;  // on a time line; empty: the class of its folder
};

// Checks that WriteDataset may write `out`: it does not exist, is an empty folder, or is a data set
// and `overwrite` is set. ALREADY_EXISTS otherwise.
absl::Status CheckOut(const std::filesystem::path& out, bool overwrite);

// Writes a data set that ParseDatasetLayout and ParseIndex read. The write is atomic: the data set
// is written next to `out`, read back, and then moved there. Replaces anything that CheckOut
// accepts. Requires a layout in metres, y up.
absl::Status WriteDataset(const std::filesystem::path& out, const dataset::DatasetLayout& layout,
                          const std::vector<ImportedSequence>& sequences);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_DATASET_FOLDER_H_
