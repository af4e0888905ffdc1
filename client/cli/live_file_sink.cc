#include "client/cli/live_file_sink.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/live_ends.h"
#include "client/cli/output.h"

namespace duet::client::cli {

absl::Status LiveFileSink::Start(const live::LeaderFormat& format) {
  leader_.joint_names = format.joint_names;
  leader_.frame_rate_hz = format.frame_rate_hz;
  leader_.poses = motion::Poses(0, leader_.joint_count());
  follower_ = leader_;
  return CheckCanCreate(path_);
}

absl::Status LiveFileSink::Accept(const LiveFrames& frames) {
  follower_.Append(frames.poses.all());
  return absl::OkStatus();
}

void LiveFileSink::AcceptLeader(const live::LeaderFrame& frame) {
  const int end = leader_.frame_count();
  if (frame.index < end) return;
  // Lost frames, which the server interpolates too.
  for (int lost = end; lost < frame.index && end > 0; ++lost) {
    const float share =
        static_cast<float>(lost - end + 1) / static_cast<float>(frame.index - end + 1);
    std::vector<motion::Vec3> pose(frame.positions.size());
    for (std::size_t joint = 0; joint < pose.size(); ++joint) {
      pose[joint] = Lerp(leader_.poses[end - 1][joint], frame.positions[joint], share);
    }
    leader_.Append(pose);
  }
  leader_.Append(frame.positions);
}

absl::StatusOr<std::vector<std::string>> LiveFileSink::Finish(const LiveInfo& info) {
  const int frames = std::min(leader_.frame_count(), follower_.frame_count());
  if (frames == 0) {
    return std::vector<std::string>{absl::StrCat(path_.string(), ": not written, no frames")};
  }
  leader_.poses.Resize(frames);
  follower_.poses.Resize(frames);
  Synthesis synthesis;
  static_cast<SynthesisOptions&>(synthesis.request) =
      static_cast<const SynthesisOptions&>(arguments_);
  synthesis.request.weights = arguments_.weights;
  for (const KeyframeArgument& keyframe : arguments_.keyframes) {
    synthesis.request.keyframes.push_back({keyframe.frame, keyframe.weights});
  }
  synthesis.result.pair = {std::move(leader_), std::move(follower_)};
  synthesis.result.model_name = info.model_name;
  synthesis.result.model_version = info.model_version;
  synthesis.result.seed = info.seed;
  synthesis.result.variety = info.variety;
  synthesis.result.candidates = info.candidates;
  synthesis.result.cleaned_up = info.cleaned_up;
  synthesis.skeleton = skeleton_;
  synthesis.leader_file = IsFile(arguments_.from) ? arguments_.from : "live";
  synthesis.sampled = true;
  synthesis.bvh = arguments_.bvh;
  const absl::StatusOr<WrittenFiles> written = WriteFollower(path_, synthesis);
  if (!written.ok()) return NotWritten(written.status());
  std::vector<std::string> lines;
  for (const std::filesystem::path& file : written->files) lines.push_back(file.string());
  for (const std::string& note : written->notes) {
    lines.push_back(absl::StrCat(path_.filename().string(), ": ", note));
  }
  return lines;
}

}  // namespace duet::client::cli
