#include "model/formats/flat/csv_joint_rows.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr std::size_t kMostPeople = 2;

}  // namespace

absl::StatusOr<bool> CsvJointRows::Add(const Row& row) {
  if (row.joint.empty()) return absl::InvalidArgumentError("joint: expected a name, got none");
  const absl::StatusOr<std::size_t> person = FindPerson(row.person);
  if (!person.ok()) return person.status();
  const absl::StatusOr<std::size_t> joint = FindJoint(*person, row.joint);
  if (!joint.ok()) return joint.status();
  const auto [frame, is_new] =
      frames_.emplace(std::string(row.frame), static_cast<int>(frames_.size()));
  if (frames_.size() > motion::kMaxMotionFrames) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
  }
  cells_.push_back({frame->second, *joint, row.position});
  return is_new;
}

absl::StatusOr<std::size_t> CsvJointRows::FindPerson(absl::string_view name) {
  const auto known = std::find(people_.begin(), people_.end(), name);
  if (known == people_.end() && people_.size() == kMostPeople) {
    return absl::InvalidArgumentError(absl::StrCat("people: expected at most ", kMostPeople,
                                                   ", got a third, ", base::Quoted(name)));
  }
  const auto person = static_cast<std::size_t>(known - people_.begin());
  if (known == people_.end()) {
    people_.emplace_back(name);
    joint_names_.emplace_back();
  }
  return person;
}

absl::StatusOr<std::size_t> CsvJointRows::FindJoint(std::size_t person, absl::string_view name) {
  const auto [known, is_new] =
      known_joints_.emplace(std::make_pair(person, std::string(name)), joints_.size());
  if (!is_new) return known->second;
  if (joints_.size() == motion::kMaxFileJoints) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected at most ", motion::kMaxFileJoints, " joints, got more"));
  }
  joints_.push_back({person, static_cast<int>(joint_names_[person].size())});
  joint_names_[person].emplace_back(name);
  return known->second;
}

const char* CsvJointRows::Hint() const {
  return people_.size() == 1 && people_[0].empty() ? "; for two people, add a column named person"
                                                   : "";
}

absl::StatusOr<std::vector<motion::Clip>> CsvJointRows::Collect() const {
  std::vector<motion::Clip> people(std::max<std::size_t>(people_.size(), 1));
  const std::size_t expected = frames_.size() * joints_.size();
  if (cells_.size() != expected) {
    return absl::InvalidArgumentError(absl::StrCat(
        "expected ", expected, " rows (one for each of ", joints_.size(), " joints in each of ",
        frames_.size(), " frames), got ", cells_.size(), cells_.size() > expected ? Hint() : ""));
  }
  for (std::size_t i = 0; i < people_.size(); ++i) {
    people[i].joint_names = joint_names_[i];
    people[i].poses = motion::Poses(static_cast<int>(frames_.size()), people[i].joint_count());
  }
  std::vector<bool> given(expected);
  for (const Cell& cell : cells_) {
    const std::size_t place = static_cast<std::size_t>(cell.frame) * joints_.size() + cell.joint;
    const Joint& joint = joints_[cell.joint];
    motion::Clip& person = people[joint.person];
    if (given[place]) {
      return absl::InvalidArgumentError(
          absl::StrCat(base::Quoted(person.joint_names[static_cast<std::size_t>(joint.place)]),
                       ": expected once per frame, got twice in the file's frame number ",
                       cell.frame + 1, Hint()));
    }
    given[place] = true;
    person.at(cell.frame, joint.place) = cell.position;
  }
  return people;
}

}  // namespace duet::formats::flat
