#ifndef DUET_MODEL_DATASET_LAYOUT_H_
#define DUET_MODEL_DATASET_LAYOUT_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"

namespace duet::dataset {

// An interaction class of a data set and how its files are told apart.
struct ClassLayout {
  std::string name;
  std::string folder;
  bool symmetric = false;      // either person may lead
  bool handed = false;         // done with one hand by custom: its mirror image does not happen
  bool touches = false;        // bodies touch as they like
  std::vector<int> effectors;  // joints whose motion tells the leader; empty: the index must
};

// What a data set's folder does not say itself: one value for each layout that ReadDataset knows.
struct DatasetLayout {
  std::string name;
  double frame_rate_hz = 0;
  motion::Coordinates coordinates;
  motion::Skeleton skeleton;
  std::vector<motion::BodyPart> parts;
  std::vector<ClassLayout> classes;
  // The horizontal world axis that the setup stands its people along, in either order.
  std::optional<motion::Vec3> people_axis;
  bool level = false;  // captured by a tilted camera: to be levelled
  // What was found rather than said, for people to read.
  std::vector<std::string> notes;
};

// SBU Kinect Interaction ("clean"): the six classes of the paper, folders 03 to 08.
DatasetLayout SbuLayout();

// sXXsYY, the two subjects of one of its sets in the order of their columns.
bool IsSbuSet(std::string_view name);

// K3HI in SBU's line layout. Rate and units are inferred, not documented by its authors.
DatasetLayout K3hiLayout();

// Parses the dataset.json of a data set of one's own (docs/datasets.md). Strict: unknown, missing
// and mistyped fields, unknown joints and a skeleton that is no tree are INVALID_ARGUMENT, naming
// the field, what came and what was wanted. `text` may come from anywhere.
absl::StatusOr<DatasetLayout> ParseDatasetLayout(std::string_view text);

// Whether `text` is the dataset.json of a set that `duet batch` made (dataset.proto): no layout;
// its files are told apart as those of SBU and K3HI.
bool DescribesBatch(std::string_view text);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LAYOUT_H_
