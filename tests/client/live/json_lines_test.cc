// JSON lines as a source and as a sink.
#include "client/live/json_lines.h"

#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/client/support/text_input.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::client::live {
namespace {

using nlohmann::json;
using test::IsOk;
using test::StatusIs;
using test::SwayingPose;

using ::testing::HasSubstr;

const std::vector<std::string>& Joints() {
  static const auto& joints = *new std::vector<std::string>(motion::SbuSkeleton().joint_names);
  return joints;
}

// The first line, with `more` fields.
std::string Header(const json& more = json::object()) {
  json line = {{"joints", Joints()}, {"rate", 30}};
  line.update(more);
  return line.dump() + "\n";
}

json Rows(const std::vector<motion::Vec3>& pose) {
  json rows = json::array();
  for (const motion::Vec3& point : pose) rows.push_back({point.x, point.y, point.z});
  return rows;
}

std::string Frame(const json& more = json::object()) {
  json line = {{"positions", Rows(SwayingPose(0))}};
  line.update(more);
  return line.dump() + "\n";
}

// A source over a text.
class Text {
 public:
  explicit Text(const std::string& text)
      : in_(text), source_(in_.descriptor(), {motion::SbuSkeleton(), {}, false}) {}
  JsonLinesSource* operator->() { return &source_; }

  // Opens it and reads everything: the events, or the first error.
  absl::StatusOr<std::vector<LeaderEvent>> ReadAll() {
    if (const auto format = source_.Open(); !format.ok()) return format.status();
    std::vector<LeaderEvent> events;
    for (;;) {
      absl::StatusOr<std::optional<LeaderEvent>> event = source_.Next();
      if (!event.ok()) return event.status();
      if (!event->has_value()) return events;
      events.push_back(**std::move(event));
    }
  }
  std::vector<int> Indices() {
    std::vector<int> indices;
    const auto events = ReadAll();
    EXPECT_THAT(events, IsOk());
    for (const LeaderEvent& event : *events) indices.push_back(std::get<LeaderFrame>(event).index);
    return indices;
  }

 private:
  const test::TextInput in_;
  JsonLinesSource source_;
};

TEST(JsonLinesSourceTest, ReadsFramesAndLabels) {
  Text text(Header() + Frame() + "\n" + R"({"labels": {"hug": 1, "kick": -0.5}, "ease": 0.3})" +
            "\n" + Frame());
  const auto events = text.ReadAll();
  ASSERT_THAT(events, IsOk());
  ASSERT_EQ(events->size(), 3u);
  EXPECT_EQ(std::get<LeaderFrame>((*events)[0]).index, 0);
  EXPECT_EQ(std::get<LeaderFrame>((*events)[0]).positions, SwayingPose(0));
  EXPECT_EQ(std::get<LeaderFrame>((*events)[2]).index, 1);
  const auto& labels = std::get<LabelCommand>((*events)[1]);
  ASSERT_EQ(labels.weights.size(), 2u);
  EXPECT_EQ(labels.weights[0].interaction_class, "hug");
  EXPECT_EQ(labels.weights[1].weight, -0.5F);
  EXPECT_EQ(labels.ease, absl::Milliseconds(300));
}

TEST(JsonLinesSourceTest, UnitsAndAxesAreConverted) {
  json rows = json::array();
  for (const motion::Vec3& p : SwayingPose(0)) rows.push_back({100 * p.x, -100 * p.z, 100 * p.y});
  Text text(Header({{"unit", "cm"}, {"up", "z"}}) + Frame({{"positions", rows}}));
  const auto events = text.ReadAll();
  ASSERT_THAT(events, IsOk());
  const auto& positions = std::get<LeaderFrame>((*events)[0]).positions;
  for (size_t joint = 0; joint < positions.size(); ++joint) {
    EXPECT_LT(Distance(positions[joint], SwayingPose(0)[joint]), 1e-5) << joint;
  }
}

TEST(JsonLinesSourceTest, NumbersAndTimesDetermineTheIndex) {
  EXPECT_EQ(Text(Header() + Frame({{"frame", 100}}) + Frame({{"frame", 101}}) +
                 Frame({{"frame", 105}}) + Frame({{"frame", 103}}))
                .Indices(),
            (std::vector<int>{0, 1, 5, 3}));
  EXPECT_EQ(Text(Header() + Frame({{"t", 10.0}}) + Frame({{"t", 10.034}}) + Frame({{"t", 10.1}}))
                .Indices(),
            (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(Text(Header() + Frame({{"frame", 7}, {"t", 1.0}}) + Frame({{"frame", 8}, {"t", 5.0}}) +
                 Frame())
                .Indices(),
            (std::vector<int>{0, 1, 2}));
}

TEST(JsonLinesSourceTest, ErrorsNameTheLineAndTheField) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "standard input: expected a line with \"joints\" and \"rate\", got no data"},
      {"walk.bvh\n", "standard input: line 1: "},
      {R"({"rate": 30})", "line 1: joints"},
      {R"({"joints": ["a"]})", "line 1: rate"},
      {Header({{"rate", 0}}), "line 1: rate: expected"},
      {Header({{"unit", "feet"}}), "line 1: unit: expected m, cm or mm"},
      {Header({{"up", "x"}}), "line 1: up: expected y, z or -y"},
      {Header({{"fps", 30}}), "line 1: "},
      {Header() + "\n" + Frame() + "{\"positions\": [[1,2\n", "line 4: "},
      {Header() + Frame({{"positions", {{1, 2, 3}}}}),
       "line 2: positions: expected 15 points, one for each joint, got 1"},
      {Header() + absl::StrReplaceAll(Frame(), {{"]]}", ",9]]}"}}),
       "line 2: positions[14]: expected three numbers within +-1000000, got ["},
      {Header() + absl::StrReplaceAll(Frame(), {{"[[", "[[null,"}}),
       "line 2: positions[0]: expected"},
      {Header() + absl::StrReplaceAll(Frame(), {{"[[", "[[1e300,"}}),
       "line 2: positions[0]: expected three numbers within +-1000000, got [1e+300,"},
      {Header() + Frame({{"pose", 1}}), "line 2: "},
      {Header() + Frame({{"frame", -1}}), "line 2: frame: expected"},
      {Header() + Frame({{"frame", 9}}) + Frame({{"frame", 8}}),
       "line 3: frame: expected at least 9, that of the first frame, and at most 1073741824 frames "
       "later, got 8"},
      {Header() + Frame({{"t", 0.5}}) + Frame({{"t", 0.1}}),
       "line 3: t: expected at least 0.5, that of the first frame,"},
      {Header({{"joints", {"a", "b"}}}) + Frame({{"positions", {{1, 2, 3}, {4, 5, 6}}}}),
       "line 2: joints: "},
      {Header() + R"({"labels": {}})", "line 2: labels: expected at least one class"},
      {Header() + R"({"labels": {"hug": "much"}})", "line 2: labels.hug: expected"},
      {Header() + R"({"labels": {"hug": 1}, "ease": 11})", "line 2: ease: expected"},
      {Header() + R"({"labels": [1]})", "line 2: labels: expected"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_THAT(Text(text).ReadAll(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(expected)))
        << text.substr(0, 200);
  }
}

TEST(JsonLinesSinkTest, WritesWhatTheSourceReads) {
  std::ostringstream out;
  JsonLinesSink sink(out);
  ASSERT_THAT(sink.Start({Joints(), 60}), IsOk());
  LiveFrames frames;
  frames.poses = motion::Poses(15, SwayingPose(0));
  ASSERT_THAT(sink.Accept(frames), IsOk());
  frames.first_frame = 1;
  frames.poses.Append(SwayingPose(1));
  ASSERT_THAT(sink.Accept(frames), IsOk());
  const auto written = sink.Finish({});
  ASSERT_THAT(written, IsOk());
  EXPECT_EQ(written->at(0), "standard output: 3 frames");
  Text text(out.str());
  const auto events = text.ReadAll();
  ASSERT_THAT(events, IsOk());
  ASSERT_EQ(events->size(), 3u);
  const auto& last = std::get<LeaderFrame>((*events)[2]);
  EXPECT_EQ(last.index, 2);
  EXPECT_LT(Distance(last.positions[14], SwayingPose(1)[14]), 1e-5);
}

TEST(JsonLinesSinkTest, AReaderThatIsGoneIsAnError) {
  std::ostringstream out;
  JsonLinesSink sink(out);
  ASSERT_THAT(sink.Start({Joints(), 60}), IsOk());
  out.setstate(std::ios::badbit);
  LiveFrames frames;
  frames.poses = motion::Poses(15, SwayingPose(0));
  EXPECT_THAT(sink.Accept(frames), StatusIs(absl::StatusCode::kAborted, HasSubstr("cannot write")));
}

TEST(LineReaderTest, ReadsLinesAsTheyArrive) {
  const test::Pipe pipe;
  LineReader lines(pipe.reader());
  pipe.Write("one\ntw");
  EXPECT_EQ(*lines.Next(), "one");
  pipe.Write("o\n\nthree");
  EXPECT_EQ(*lines.Next(), "two");
  EXPECT_EQ(*lines.Next(), "");
  pipe.CloseWriter();
  EXPECT_EQ(*lines.Next(), "three") << "without an end";
  EXPECT_EQ(*lines.Next(), std::nullopt);
}

TEST(LineReaderTest, StopInterruptsAReaderThatWaits) {
  const test::Pipe pipe;
  LineReader lines(pipe.reader());
  pipe.Write("half a li");
  std::thread stopper([&lines] { lines.Stop(); });
  EXPECT_EQ(*lines.Next(), std::nullopt);
  stopper.join();
  pipe.CloseWriter();
}

TEST(LineReaderTest, ALineIsNotEndless) {
  const test::TextInput in(std::string(kMaxLineBytes + 100000, 'x'));
  EXPECT_THAT(LineReader(in.descriptor()).Next(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("at most 1048576 bytes")));
}

}  // namespace
}  // namespace duet::client::live
