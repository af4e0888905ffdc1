#ifndef DUET_MODEL_FORMATS_FLAT_CSV_JOINT_ROWS_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_JOINT_ROWS_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/vec3.h"

namespace duet::formats::flat {

// Builds motions from rows in any order. Each row holds one joint in one frame.
//
// Errors: INVALID_ARGUMENT with the expected value and the actual one.
class CsvJointRows {
 public:
  struct Row {
    absl::string_view frame;   // number or time, as in the file
    absl::string_view person;  // empty if the file has one person
    absl::string_view joint;
    motion::Vec3 position;
  };

  // Returns whether the row's frame is new.
  absl::StatusOr<bool> Add(const Row& row);

  // One or two people, without a frame rate. The person of the first row is the leader. Fails
  // unless each joint of each person occurs once in every frame.
  absl::StatusOr<std::vector<motion::Clip>> Collect() const;

 private:
  struct Joint {
    std::size_t person = 0;
    int place = 0;  // index into the person's joints
  };
  struct Cell {
    int frame = 0;
    std::size_t joint = 0;  // into joints_
    motion::Vec3 position;
  };
  absl::StatusOr<std::size_t> FindPerson(absl::string_view name);
  absl::StatusOr<std::size_t> FindJoint(std::size_t person, absl::string_view name);
  // A hint for files of two people without a column for the person; empty for others.
  const char* Hint() const;

  std::map<std::string, int> frames_;
  std::vector<std::string> people_;
  std::vector<std::vector<std::string>> joint_names_;  // of each person
  std::map<std::pair<std::size_t, std::string>, std::size_t> known_joints_;
  std::vector<Joint> joints_;
  std::vector<Cell> cells_;
};

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_JOINT_ROWS_H_
