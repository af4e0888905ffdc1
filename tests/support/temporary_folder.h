#ifndef DUET_TESTS_SUPPORT_TEMPORARY_FOLDER_H_
#define DUET_TESTS_SUPPORT_TEMPORARY_FOLDER_H_

#include <filesystem>
#include <string>
#include <string_view>

namespace duet::test {

// An empty folder of one test, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// The whole content of a file; a test failure and "" if it cannot be read.
std::string ReadTestFile(const std::filesystem::path& path);
// Writes or replaces a file; a test failure if it cannot be written.
void WriteTestFile(const std::filesystem::path& path, std::string_view content);

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_TEMPORARY_FOLDER_H_
