#include "model/dataset/lone_leaders.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"
#include "model/base/status_macros.h"
#include "model/formats/motion_file.h"
#include "model/motion/resample.h"

namespace duet::dataset {

namespace fs = std::filesystem;

absl::StatusOr<std::vector<fs::path>> MotionFilesBelow(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    if (it->is_regular_file(unknown) && formats::IsReadable(it->path())) {
      files.push_back(it->path());
    }
  }
  if (error) {
    return absl::NotFoundError(
        absl::StrCat(folder.string(), ": cannot be listed: ", error.message()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

absl::StatusOr<std::vector<LoneLeader>> ReadLoneLeaders(const fs::path& folder,
                                                        const motion::Skeleton& skeleton,
                                                        double frame_rate_hz) {
  DUET_TRY(const std::vector<fs::path> files, MotionFilesBelow(folder));
  formats::ReadOptions options;
  options.skeleton = skeleton;
  std::vector<LoneLeader> leaders;
  for (const fs::path& file : files) {
    DUET_TRY(const motion::Clip clip, formats::ReadLeader(file, options));
    if (clip.frame_count() < 2) {
      return absl::InvalidArgumentError(
          absl::StrCat(file.string(), ": frames: expected at least 2, got ", clip.frame_count()));
    }
    leaders.push_back({file.lexically_relative(folder).generic_string(),
                       motion::Resample(clip.poses, clip.frame_rate_hz, frame_rate_hz)});
  }
  if (!leaders.empty()) return leaders;
  return absl::NotFoundError(
      absl::StrCat(folder.string(), ": expected motion files of leaders, got none"));
}

std::string DigestOf(const std::vector<LoneLeader>& leaders) {
  std::string bytes;
  for (const LoneLeader& leader : leaders) {
    const absl::Span<const motion::Vec3> points = leader.poses.all();
    absl::StrAppend(&bytes, leader.id, "\n", leader.poses.frame_count(), "\n");
    bytes.append(reinterpret_cast<const char*>(points.data()),
                 points.size() * sizeof(motion::Vec3));
  }
  return base::Sha256Hex(bytes);
}

}  // namespace duet::dataset
