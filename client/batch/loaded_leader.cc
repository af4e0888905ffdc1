#include "client/batch/loaded_leader.h"

#include <optional>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/batch/text_values.h"
#include "model/base/sha256.h"
#include "model/motion/reading_setting.h"
#include "model/motion/stated_unit.h"

namespace duet::client::batch {
namespace {

absl::StatusOr<FollowerStart> ReadStart(const std::filesystem::path& file,
                                        const formats::ReadOptions& options) {
  absl::StatusOr<std::vector<motion::Vec3>> pose = formats::ReadFollowerStart(file, options);
  if (!pose.ok()) return pose.status();
  return FollowerStart(*std::move(pose));
}

absl::Status SetStart(const LeaderEntry& entry, formats::Side side, const LeaderInput& input,
                      formats::ReadOptions options, LoadedLeader* loaded) {
  const std::string& start = entry.follower_start;
  if (start.empty() && !input.starts_as_other_person) return absl::OkStatus();
  if (const std::optional<motion::Vec3> root = ParsePoint(start); root.has_value()) {
    loaded->follower_start = *root;
    return absl::OkStatus();
  }
  const std::filesystem::path file = start.empty() ? entry.file : std::filesystem::path(start);
  std::error_code error;
  // In the leader's own file, the follower is the other person.
  const bool own = start.empty() || std::filesystem::equivalent(file, entry.file, error);
  // The settings describe leaders; another file may have another format.
  if (!own && formats::IsReadable(file)) options.format.reset();
  options.side = own ? OtherSide(side) : formats::Side::kLeft;
  absl::StatusOr<FollowerStart> pose = ReadStart(file, options);
  if (!pose.ok()) return pose.status();
  loaded->follower_start = *std::move(pose);
  if (own) return absl::OkStatus();
  absl::StatusOr<std::string> digest = base::Sha256HexOfFile(file);
  if (!digest.ok()) return digest.status();
  loaded->start_sha256 = *std::move(digest);
  return absl::OkStatus();
}

// Checks the limits that would make the server reject every call with this leader.
absl::Status CheckLimits(const std::filesystem::path& file, const motion::Clip& clip,
                         const RequestLimits& limits) {
  const auto refuse = [&file](const auto&... what) {
    return absl::InvalidArgumentError(absl::StrCat(file.string(), ": ", what...));
  };
  const double rate_hz = clip.frame_rate_hz;
  const int frames = clip.frame_count();
  if (frames < limits.min_frames) {
    return refuse("frames: expected at least ", limits.min_frames, ", got ", frames);
  }
  if (limits.max_frame_rate_hz > 0 &&
      (rate_hz < limits.min_frame_rate_hz || rate_hz > limits.max_frame_rate_hz)) {
    return refuse("frame rate: expected ", limits.min_frame_rate_hz, " to ",
                  limits.max_frame_rate_hz, " Hz, got ", rate_hz,
                  ". Resample it (duet convert --resample HZ).");
  }
  const double max_seconds = absl::ToDoubleSeconds(limits.max_duration);
  if (max_seconds > 0 && frames > max_seconds * rate_hz) {
    return refuse("duration: expected at most ", max_seconds, " s, got ", frames / rate_hz,
                  " s. Cut it into several leaders.");
  }
  return absl::OkStatus();
}

absl::StatusOr<LoadedLeader> Load(const LeaderEntry& entry, formats::Side side,
                                  const LeaderInput& input, const motion::Skeleton& skeleton,
                                  const RequestLimits& limits) {
  formats::ReadOptions options = input.reading;
  options.skeleton = skeleton;
  options.side = side;
  absl::StatusOr<motion::Clip> clip = formats::ReadLeader(entry.file, options);
  if (!clip.ok()) return clip.status();
  absl::Status status = CheckLimits(entry.file, *clip, limits);
  if (!status.ok()) return status;
  absl::StatusOr<std::string> digest = base::Sha256HexOfFile(entry.file);
  if (!digest.ok()) return digest.status();
  LoadedLeader loaded;
  loaded.clip = *std::move(clip);
  loaded.sha256 = *std::move(digest);
  status = SetStart(entry, side, input, options, &loaded);
  if (!status.ok()) return status;
  return loaded;
}

absl::Status WithMendingField(const absl::Status& status) {
  const absl::string_view field = motion::MendingField(status);
  if (field.empty()) return status;
  return absl::Status(
      status.code(),
      absl::StrCat(status.message(), "; specify it in the recipe: input { ", field, " }"));
}

// Whether two lines read the same motion.
bool SameMotion(const LeaderEntry& a, const LeaderEntry& b) {
  return a.file == b.file && a.follower_start == b.follower_start;
}

}  // namespace

absl::StatusOr<LoadedLeader> LoadLeader(const LeaderEntry& entry, formats::Side side,
                                        const LeaderInput& input, const motion::Skeleton& skeleton,
                                        const RequestLimits& limits) {
  absl::StatusOr<LoadedLeader> loaded = Load(entry, side, input, skeleton, limits);
  if (!loaded.ok()) return WithMendingField(loaded.status());
  return loaded;
}

std::shared_ptr<SharedLeader> LastLeaders::Get(const std::shared_ptr<const LeaderEntry>& entry,
                                               formats::Side side, int skeleton) {
  Last& last = last_[static_cast<size_t>(skeleton)];
  if (last.leader == nullptr || last.side != side ||
      (last.entry != entry && !SameMotion(*last.entry, *entry))) {
    last = {entry, side, std::make_shared<SharedLeader>(entry, side)};
  }
  return last.leader;
}

}  // namespace duet::client::batch
