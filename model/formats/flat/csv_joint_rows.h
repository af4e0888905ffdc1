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

// Makes motions of rows in any order, each of one joint in one frame.
//
// Errors: INVALID_ARGUMENT, what came and what was wanted.
class CsvJointRows {
 public:
  struct Row {
    absl::string_view frame;   // by what the file calls it
    absl::string_view person;  // empty: the file has one
    absl::string_view joint;
    motion::Vec3 position;
  };

  // Whether the row's frame is a new one.
  absl::StatusOr<bool> Add(const Row& row);

  // One person or two, the one that came first the leader; no rate yet. Wants every joint of either
  // once in every frame.
  absl::StatusOr<std::vector<motion::Clip>> Collect() const;

 private:
  struct Joint {
    std::size_t person = 0;
    int place = 0;  // among the person's
  };
  struct Cell {
    int frame = 0;
    std::size_t joint = 0;  // into joints_
    motion::Vec3 position;
  };
  absl::StatusOr<std::size_t> FindPerson(absl::string_view name);
  absl::StatusOr<std::size_t> FindJoint(std::size_t person, absl::string_view name);
  // What tells people apart, where nothing did.
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
