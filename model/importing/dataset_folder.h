#ifndef DUET_MODEL_IMPORTING_DATASET_FOLDER_H_
#define DUET_MODEL_IMPORTING_DATASET_FOLDER_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/dataset/layout.h"
#include "model/dataset/leader_side.h"
#include "model/importing/capture.h"

namespace duet::importing {

// A sequence as it goes into a data set.
struct ImportedSequence {
  Capture capture;  // metres, y up
  dataset::LeaderSide leader_side = dataset::LeaderSide::kUnknown;
  std::string leader_source;
};

// Whether WriteDataset would find `out` free: nothing there, an empty folder, or a data set where
// it may overwrite. ALREADY_EXISTS otherwise.
absl::Status CheckOut(const std::filesystem::path& out, bool overwrite);

// Writes a data set as ParseDatasetLayout and ParseIndex read it, whole or not at all: beside its
// place, read back, then moved there. `layout` has metres, y up. Whatever CheckOut lets pass is
// replaced.
absl::Status WriteDataset(const std::filesystem::path& out, const dataset::DatasetLayout& layout,
                          const std::vector<ImportedSequence>& sequences);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_DATASET_FOLDER_H_
