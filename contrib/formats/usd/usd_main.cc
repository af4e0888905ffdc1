// Converts a motion of one person or two to text USD: duet-usd IN OUT.usda
#include <filesystem>
#include <iostream>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "contrib/formats/usd/usda_export.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"
#include "model/formats/people.h"

namespace duet::contrib::formats::usd {
namespace {

namespace motion_files = ::duet::formats;

absl::Status Convert(const std::filesystem::path& in, const std::filesystem::path& out) {
  const motion_files::ReadOptions options;
  const absl::StatusOr<motion_files::ReadPeople> read = motion_files::ReadAllPeople(
      [&in](const motion_files::ReadOptions& person) {
        return motion_files::ReadLeader(in, person);
      },
      options);
  if (!read.ok()) return read.status();
  const absl::StatusOr<std::string> text = FormatUsda(read->people, options.skeleton);
  return text.ok() ? base::WriteFile(out, *text) : text.status();
}

}  // namespace
}  // namespace duet::contrib::formats::usd

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "Usage: duet-usd IN OUT.usda\n";
    return 2;
  }
  const absl::Status status = duet::contrib::formats::usd::Convert(argv[1], argv[2]);
  if (!status.ok()) std::cerr << "duet-usd: " << status.message() << "\n";
  return status.ok() ? 0 : 1;
}
