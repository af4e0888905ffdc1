#include "client/live/json_lines_sink.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/counted.h"
#include "nlohmann/json.hpp"

namespace duet::client::live {

absl::Status JsonLinesSink::Start(const LeaderFormat& format) {
  const nlohmann::ordered_json line = {
      {"joints", format.joint_names}, {"rate", format.frame_rate_hz}, {"unit", "m"}, {"up", "y"}};
  out_ << line.dump() << '\n';
  return Flush();
}

absl::Status JsonLinesSink::Accept(const LiveFrames& frames) {
  for (int frame = 0; frame < frames.poses.frame_count(); ++frame) {
    std::string line =
        absl::StrCat("{\"frame\": ", frames.first_frame + frame, ", \"positions\": [");
    const char* separator = "";
    for (const motion::Vec3& point : frames.poses[frame]) {
      absl::StrAppendFormat(&line, "%s[%.5f, %.5f, %.5f]", separator, point.x, point.y, point.z);
      separator = ", ";
    }
    absl::StrAppend(&line, "]}\n");
    out_ << line;
    ++frames_;
  }
  return Flush();
}

absl::StatusOr<std::vector<std::string>> JsonLinesSink::Finish(const LiveInfo& /*info*/) {
  absl::Status status = Flush();
  if (!status.ok()) return status;
  return std::vector<std::string>{
      absl::StrCat("standard output: ", base::Counted(frames_, "frame"))};
}

absl::Status JsonLinesSink::Flush() {
  out_.flush();
  if (out_.good()) return absl::OkStatus();
  return absl::AbortedError("standard output: cannot write all of it");
}

}  // namespace duet::client::live
