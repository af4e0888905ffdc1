#ifndef DUET_CLIENT_LIVE_JSON_LINES_H_
#define DUET_CLIENT_LIVE_JSON_LINES_H_

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "client/live/live_run.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "nlohmann/json.hpp"

namespace duet::client::live {

// The longest line that is read, in bytes.
inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

// Reads the lines of a file descriptor, which it does not close and which may be slow, such as a
// pipe.
//
// Threads: Next is called by one thread; Stop by any.
class LineReader {
 public:
  explicit LineReader(int descriptor);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  ~LineReader();

  // Blocks until the next line, which it returns without its end. Absent: the end of the input, or
  // Stop was called. Errors: INVALID_ARGUMENT for a line of more than kMaxLineBytes.
  absl::StatusOr<std::optional<std::string>> Next();
  // Interrupts Next.
  void Stop();

 private:
  std::optional<std::string> Take(std::size_t length, std::size_t taken);
  bool Read();

  const int descriptor_;
  const int stop_;
  std::string buffer_;
  std::size_t searched_ = 0;  // the buffer's bytes before this one hold no end of a line
  bool stopped_ = false;
};

// How JSON lines are read.
struct JsonLinesOptions {
  motion::Skeleton skeleton;  // the model's
  retargeting::JointOverrides joints;
  bool is_live = false;  // see LeaderSource::IsLive
};

// A leader as lines of JSON. The first line describes the frames:
//
//   {"joints": ["head", ...], "rate": 30, "unit": "m", "up": "y"}
//
// `unit` is m, cm or mm (default: m), `up` is y, z or -y (default: y). Joints are found by name, as
// in motion files. Then one line for each frame, and one for each change of the labels:
//
//   {"positions": [[x, y, z], ...], "frame": 17, "t": 0.567}
//   {"labels": {"hug": 1, "kick": -0.5}, "ease": 0.3}
//
// `frame` is the frame's index; without it, `t`, the time of capture in seconds, determines the
// nearest index. Without both, frames are counted. The first frame is index 0, whatever its number
// or time. `ease` is in seconds; the default is 0. Empty lines are ignored.
//
// Errors: INVALID_ARGUMENT naming the line, the field, the expected value and the actual one.
class JsonLinesSource final : public LeaderSource {
 public:
  JsonLinesSource(int descriptor, JsonLinesOptions options)
      : lines_(descriptor), options_(std::move(options)) {}

  absl::StatusOr<LeaderFormat> Open() override;
  absl::StatusOr<std::optional<LeaderEvent>> Next() override;
  void Stop() override { lines_.Stop(); }
  bool IsLive() const override { return options_.is_live; }
  std::vector<std::string> Notes() const override { return retargeting::JointNotes(joints_); }

 private:
  absl::StatusOr<std::optional<nlohmann::json>> NextObject();
  absl::StatusOr<LeaderFormat> ReadFormat(const nlohmann::json& object);
  absl::StatusOr<LeaderEvent> ReadFrame(const nlohmann::json& object);
  absl::StatusOr<LeaderEvent> ReadLabels(const nlohmann::json& object);
  absl::StatusOr<std::vector<motion::Vec3>> ReadPositions(const nlohmann::json& rows);
  absl::Status MapJoints(const std::vector<motion::Vec3>& pose);
  absl::Status InLine(const absl::Status& status) const;

  LineReader lines_;
  const JsonLinesOptions options_;
  int line_ = 0;
  std::vector<std::string> joint_names_;
  double frame_rate_hz_ = 0;
  float metres_per_unit_ = 1;
  motion::Coordinates coordinates_;
  std::optional<retargeting::JointMap> map_;       // after the first frame
  std::vector<retargeting::JointReading> joints_;  // how it was made
  int next_index_ = 0;
  std::optional<int64_t> first_frame_;  // the first frame's number
  std::optional<double> first_time_;    // and time
};

// Writes the follower as lines of JSON, each complete when it is written:
//
//   {"joints": ["head", ...], "rate": 30, "unit": "m", "up": "y"}
//   {"frame": 0, "positions": [[x, y, z], ...]}
//
// Positions have five decimals (0.01 mm). Errors: ABORTED if the reader is gone.
class JsonLinesSink final : public FollowerSink {
 public:
  // `out` outlives the sink.
  explicit JsonLinesSink(std::ostream& out) : out_(out) {}

  absl::Status Start(const LeaderFormat& format) override;
  absl::Status Accept(const LiveFrames& frames) override;
  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override;

 private:
  absl::Status Flush();

  std::ostream& out_;
  int frames_ = 0;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_JSON_LINES_H_
