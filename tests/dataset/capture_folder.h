#ifndef DUET_TESTS_DATASET_CAPTURE_FOLDER_H_
#define DUET_TESTS_DATASET_CAPTURE_FOLDER_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "model/motion/vec3.h"

namespace duet {

// A folder of made-up captures that is gone after the test.
class CaptureFolder {
 public:
  CaptureFolder() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("duet_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~CaptureFolder() { std::filesystem::remove_all(path_); }
  CaptureFolder(const CaptureFolder&) = delete;
  CaptureFolder& operator=(const CaptureFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((path_ / file).parent_path());
    std::ofstream(path_ / file, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

// A line of the SBU layout: `left` and `right` hold every joint of a person.
inline std::string CaptureLine(int frame, const std::vector<Vec3>& left,
                               const std::vector<Vec3>& right) {
  std::string line = std::to_string(frame);
  for (const std::vector<Vec3>* person : {&left, &right}) {
    for (const Vec3& p : *person) {
      for (float value : {p.x, p.y, p.z}) line += "," + std::to_string(value);
    }
  }
  return line + "\n";
}

// Two people of 15 joints, standing still for `frames` frames; every value is the joint's number
// plus the person's offset (100 for the right one).
inline std::string StillCapture(int frames) {
  std::vector<Vec3> left(15), right(15);
  for (size_t j = 0; j < 15; ++j) {
    const float value = static_cast<float>(j);
    left[j] = {value, value, value};
    right[j] = {100 + value, 100 + value, 100 + value};
  }
  std::string text;
  for (int t = 0; t < frames; ++t) text += CaptureLine(t + 1, left, right);
  return text;
}

}  // namespace duet

#endif  // DUET_TESTS_DATASET_CAPTURE_FOLDER_H_
