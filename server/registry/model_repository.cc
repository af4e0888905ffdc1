#include "server/registry/model_repository.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/motion/vec3.h"
#include "server/common/clock.h"

namespace duet::server::registry {

namespace {

namespace fs = std::filesystem;

bool IsVersion(const std::string& text) {
  int32_t version{};
  return absl::SimpleAtoi(text, &version) && version >= 1 && absl::StrCat(version) == text;
}

// The folders inside a folder.
absl::StatusOr<std::vector<fs::path>> Subfolders(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  std::vector<fs::path> folders;
  while (!error && entries != fs::directory_iterator()) {
    std::error_code ignored;
    if (entries->is_directory(ignored)) folders.push_back(entries->path());
    entries.increment(error);
  }
  if (!error) return folders;
  const std::string message =
      absl::StrCat("cannot read the folder ", folder.string(), ": ", error.message());
  if (error == std::errc::permission_denied) return absl::PermissionDeniedError(message);
  return absl::NotFoundError(message);
}

absl::Status CheckPlace(const fs::path& folder, const engine::ModelDescription& model) {
  const std::string name = folder.parent_path().filename().string();
  const std::string version = folder.filename().string();
  if (model.name == name && absl::StrCat(model.version) == version) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("manifest: expected model ", name, " version ",
                                                 version, " as in the folder, got ", model.name,
                                                 " version ", model.version));
}

bool IsHidden(const fs::path& path) { return absl::StartsWith(path.filename().string(), "."); }

// A volume's folder whose content changes all at once lies behind this link.
constexpr char kVolumeData[] = "..data";

constexpr char kManifest[] = "manifest.json";

// Looks through one model's folder.
void ListVersions(const fs::path& name, RepositoryListing& listing) {
  const std::string model = name.filename().string();
  absl::StatusOr<std::vector<fs::path>> versions = Subfolders(name);
  // A volume's own folders (lost+found) may well be closed to us.
  if (!versions.ok()) {
    listing.skipped.push_back({model, std::string(versions.status().message())});
    return;
  }
  bool has_versions = false;
  for (fs::path& version : *versions) {
    if (IsHidden(version)) continue;
    has_versions = true;
    const std::string folder = absl::StrCat(model, "/", version.filename().string());
    std::error_code ignored;
    if (!IsVersion(version.filename().string())) {
      listing.skipped.push_back(
          {folder, "expected a version of at least 1 without leading zeros as the folder's name"});
    } else if (!fs::exists(ResolveCheckpoint(version) / kManifest, ignored)) {
      listing.skipped.push_back({folder, "expected a manifest.json, got none"});
    } else {
      listing.checkpoints.push_back(std::move(version));
    }
  }
  if (!has_versions) {
    listing.skipped.push_back({model, "has no folder of a version, such as 1"});
  }
}

}  // namespace

absl::StatusOr<RepositoryListing> ListCheckpoints(const fs::path& repository) {
  absl::StatusOr<std::vector<fs::path>> names = Subfolders(repository);
  if (!names.ok()) return names.status();
  RepositoryListing listing;
  for (const fs::path& name : *names) {
    if (!IsHidden(name)) ListVersions(name, listing);
  }
  std::sort(listing.checkpoints.begin(), listing.checkpoints.end());
  std::sort(listing.skipped.begin(), listing.skipped.end(),
            [](const auto& a, const auto& b) { return a.folder < b.folder; });
  return listing;
}

fs::path ResolveCheckpoint(const fs::path& folder) {
  std::error_code error;
  fs::path resolved = fs::canonical(folder / kVolumeData, error);
  if (error) resolved = fs::canonical(folder, error);
  return error ? folder : resolved;
}

std::string FilesOf(const fs::path& folder) {
  std::set<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(ResolveCheckpoint(folder), error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    struct stat file = {};
    if (IsHidden(name) || absl::EndsWith(name, ".md")) continue;
    if (stat(entry->path().c_str(), &file) != 0 || !S_ISREG(file.st_mode)) continue;
    // Programs cannot set the change time (ctim), so it differs even if the others were restored.
    files.insert(absl::StrCat(name, " ", file.st_dev, ":", file.st_ino, ":", file.st_size, ":",
                              file.st_mtim.tv_sec, ".", file.st_mtim.tv_nsec, ":",
                              file.st_ctim.tv_sec, ".", file.st_ctim.tv_nsec));
  }
  return absl::StrJoin(files, "\n");
}

LoadReport LoadCheckpoint(const fs::path& folder, const ModelLoader& loader) {
  const common::TimePoint begin = common::Clock::Real().Now();
  LoadReport report{(folder.parent_path().filename() / folder.filename()).string(),
                    loader(ResolveCheckpoint(folder)), 0};
  if (report.model.ok()) {
    absl::Status checked = CheckPlace(folder, (*report.model)->description());
    if (checked.ok()) checked = CheckAnswers(**report.model);
    if (!checked.ok()) report.model = checked;
  }
  report.load_seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  return report;
}

namespace {

using motion::Vec3;

// Enough frames to distinguish valid weights from corrupt ones, independent of the window length.
constexpr int kFrames = 60;
constexpr double kBoneMetres = 0.3;
constexpr double kHipMetres = 0.12;
constexpr double kSwayMetres = 0.05;

// Returns the joints from the root down to `foot`.
std::vector<bool> LegTo(int foot, const motion::Skeleton& skeleton) {
  std::vector<bool> leg(skeleton.joint_names.size());
  const std::vector<int> parents = skeleton.Parents();
  for (int joint = foot; joint >= 0 && joint != skeleton.root;
       joint = parents[static_cast<std::size_t>(joint)]) {
    leg[static_cast<std::size_t>(joint)] = true;
  }
  return leg;
}

// Legs point down; all other bones point up and outwards, each in a different direction.
std::vector<Vec3> StandingPose(const motion::Skeleton& skeleton) {
  std::vector<Vec3> pose(skeleton.joint_names.size());
  std::vector<bool> left(pose.size());
  std::vector<bool> right(pose.size());
  if (skeleton.feet.has_value()) {
    left = LegTo(skeleton.feet->left, skeleton);
    right = LegTo(skeleton.feet->right, skeleton);
  }
  constexpr double kGoldenAngle = 2.4;
  for (const int index : BonesFromRoot(skeleton)) {
    const motion::Bone& bone = skeleton.bones[static_cast<std::size_t>(index)];
    const auto child = static_cast<std::size_t>(bone.child);
    const double angle = kGoldenAngle * index;
    Vec3 offset = {static_cast<float>(kBoneMetres * 0.6 * std::cos(angle)),
                   static_cast<float>(kBoneMetres * 0.7),
                   static_cast<float>(kBoneMetres * 0.4 * std::sin(angle))};
    if (left[child] != right[child]) {
      const auto parent = static_cast<std::size_t>(bone.parent);
      const double side =
          left[parent] == right[parent] ? kHipMetres : 0;  // where the legs separate
      offset = {static_cast<float>(left[child] ? side : -side), static_cast<float>(-kBoneMetres),
                0};
    }
    pose[child] = pose[static_cast<std::size_t>(bone.parent)] + offset;
  }
  const auto lowest = std::min_element(pose.begin(), pose.end(),
                                       [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
  const Vec3 lift = {0, -lowest->y, 0};
  for (Vec3& position : pose) position += lift;
  return pose;
}

// Returns one window without a class and one for each class.
std::vector<engine::SynthesisWindow> GoldenWindows(const engine::ModelDescription& model) {
  const int frames = std::min(kFrames, model.window_frames);
  const std::size_t classes = model.classes.size();
  engine::SynthesisWindow window;
  window.leader = GoldenLeader(model.skeleton, frames, model.frame_rate_hz);
  window.labels.assign(static_cast<std::size_t>(frames) * classes, 0);
  window.options.clean_up = false;
  std::vector<engine::SynthesisWindow> windows(classes + 1, window);
  for (std::size_t label = 0; label < classes; ++label) {
    for (std::size_t t = 0; t < static_cast<std::size_t>(frames); ++t) {
      windows[label + 1].labels[t * classes + label] = 1;
    }
  }
  return windows;
}

absl::Status CheckFollower(const motion::Poses& follower, const engine::SynthesisWindow& window,
                           const engine::ModelDescription& model) {
  const int frames = std::min(follower.frame_count(), window.leader.frame_count());
  for (int t = 0; t < frames; ++t) {
    const Vec3 leader = window.leader.at(t, model.skeleton.root);
    for (int joint = 0; joint < follower.joint_count(); ++joint) {
      const float distance = Distance(follower.at(t, joint), leader);
      // Negated, so that NaN is rejected.
      if (distance <= kFarthestFollower) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("weights: expected every joint of a follower within ", kFarthestFollower,
                       " m of a standing leader, got ",
                       model.skeleton.joint_names[static_cast<std::size_t>(joint)], " at ",
                       distance, " m in frame ", t));
    }
  }
  return absl::OkStatus();
}

}  // namespace

motion::Poses GoldenLeader(const motion::Skeleton& skeleton, int frames, double frame_rate_hz) {
  const std::vector<Vec3> pose = StandingPose(skeleton);
  motion::Poses leader(frames, skeleton.joint_count());
  for (int t = 0; t < frames; ++t) {
    const double seconds = t / frame_rate_hz;
    for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
      // Higher joints sway farther, and joints sway one after another.
      const Vec3 position = pose[static_cast<std::size_t>(joint)];
      const double sway = kSwayMetres * position.y;
      leader.at(t, joint) =
          position + Vec3{static_cast<float>(sway * std::sin(2 * seconds + 0.1 * joint)), 0,
                          static_cast<float>(sway * std::cos(3 * seconds + 0.2 * joint))};
    }
  }
  return leader;
}

absl::Status CheckAnswers(const engine::Synthesizer& model) {
  const std::vector<engine::SynthesisWindow> windows = GoldenWindows(model.description());
  std::vector<const engine::SynthesisWindow*> pointers;
  for (const engine::SynthesisWindow& window : windows) pointers.push_back(&window);
  const std::vector<engine::WindowResult> results = model.Synthesize(pointers);
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i].ok()) {
      return absl::Status(results[i].status().code(),
                          absl::StrCat("weights: expected a follower for a standing leader, got: ",
                                       results[i].status().message()));
    }
    const absl::Status checked = CheckFollower(*results[i], windows[i], model.description());
    if (!checked.ok()) return checked;
  }
  return absl::OkStatus();
}

}  // namespace duet::server::registry
