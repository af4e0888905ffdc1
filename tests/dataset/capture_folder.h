#ifndef DUET_TESTS_DATASET_CAPTURE_FOLDER_H_
#define DUET_TESTS_DATASET_CAPTURE_FOLDER_H_

#include <filesystem>
#include <string>
#include <vector>

#include "model/motion/vec3.h"
#include "tests/support/temporary_folder.h"

namespace duet::dataset {

using test::TemporaryFolder;
using test::WriteTestFile;

// A folder of made-up captures that is gone after the test.
class CaptureFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((path() / file).parent_path());
    WriteTestFile(path() / file, text);
  }

 private:
  TemporaryFolder folder_;
};

// A line of the SBU layout: `left` and `right` hold every joint of a person.
inline std::string CaptureLine(int frame, const std::vector<motion::Vec3>& left,
                               const std::vector<motion::Vec3>& right) {
  std::string line = std::to_string(frame);
  for (const std::vector<motion::Vec3>* person : {&left, &right}) {
    for (const motion::Vec3& p : *person) {
      for (float value : {p.x, p.y, p.z}) line += "," + std::to_string(value);
    }
  }
  return line + "\n";
}

// Two people of 15 joints, standing still for `frames` frames; every value is the joint's number
// plus the person's offset (100 for the right one).
inline std::string StillCapture(int frames) {
  std::vector<motion::Vec3> left(15), right(15);
  for (size_t j = 0; j < 15; ++j) {
    const float value = static_cast<float>(j);
    left[j] = {value, value, value};
    right[j] = {100 + value, 100 + value, 100 + value};
  }
  std::string text;
  for (int t = 0; t < frames; ++t) text += CaptureLine(t + 1, left, right);
  return text;
}

}  // namespace duet::dataset

#endif  // DUET_TESTS_DATASET_CAPTURE_FOLDER_H_
