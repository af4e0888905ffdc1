#ifndef DUET_MODEL_DATASET_LAYOUT_H_
#define DUET_MODEL_DATASET_LAYOUT_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"
#include "model/motion/skeleton_json.h"

namespace duet::dataset {

// An interaction class of a data set, and the folder of its files.
struct ClassLayout {
  std::string name;
  std::string folder;
  bool symmetric = false;  // either person may lead
  bool handed = false;     // done with one hand by custom: its mirror image does not occur
  bool touches = false;    // bodies may touch
  std::vector<int>
      effectors;  // joints of the motion rule; if empty, the index must name the leader
};

// The properties that a data set's files do not state. There is one value for each layout that
// ReadDataset supports.
struct DatasetLayout {
  std::string name;
  double frame_rate_hz = 0;
  motion::Coordinates coordinates;
  motion::Skeleton skeleton;
  std::vector<motion::BodyPart> parts;
  std::vector<ClassLayout> classes;
  // The horizontal world axis along which people stand in this setup, in either order.
  std::optional<motion::Vec3> people_axis;
  bool level = false;  // captured by a tilted camera: ReadDataset levels it
  // The inferred values, for people to read.
  std::vector<std::string> notes;
};

// SBU Kinect Interaction ("clean"): the six classes of the paper, folders 03 to 08.
DatasetLayout SbuLayout();

// sXXsYY, the two subjects of one of its sets in the order of their columns.
bool IsSbuSet(std::string_view name);

// K3HI in SBU's line layout. Rate and units are inferred, not documented by its authors.
DatasetLayout K3hiLayout();

// Parses the dataset.json of your own data set (docs/datasets.md). `text` is untrusted. Unknown,
// missing and mistyped fields, unknown joints and a skeleton that is not a tree are
// INVALID_ARGUMENT, naming the field, the expected value and the actual one.
absl::StatusOr<DatasetLayout> ParseDatasetLayout(std::string_view text);

// Reads a "skeleton" object that people write, in dataset.json or a file of its own. Without
// `parts`, adds the parts, and the root, hips and feet that are missing, from its bones and joint
// names (retargeting/anatomy.h). The root is the joint to which no bone leads. `notes` receives one
// line for each assumption. Errors: those of motion::ReadSkeleton; INVALID_ARGUMENT naming what
// cannot be inferred, and the fields that specify it.
absl::StatusOr<motion::SkeletonDocument> ReadWrittenSkeleton(nlohmann::json object,
                                                             std::vector<std::string>* notes);

// Whether `text` is the dataset.json of a set that `duet batch` made (dataset.proto). That is not a
// layout: the folders of such a set are recognised like those of SBU and K3HI.
bool DescribesBatch(std::string_view text);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LAYOUT_H_
