// The readers of Xsens and Rokoko, and addresses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "client/capture/capture_address.h"
#include "client/capture/lz4_frame.h"
#include "client/capture/rokoko_reader.h"
#include "client/capture/xsens_reader.h"
#include "model/base/hex.h"
#include "tests/client/capture/datagrams.h"
#include "tests/support/matchers.h"

namespace duet::client::capture {
namespace {

// Made by `lz4 -9 --no-frame-crc` 1.9.4 of 200 times "duet" and "end".
constexpr char kLz4Frame[] = "04224d18604082110000004f647565740400ffffff0a506574656e6400000000";

std::vector<motion::Vec3> SomePositions(std::size_t count) {
  std::vector<motion::Vec3> positions;
  for (std::size_t i = 0; i < count; ++i) {
    positions.push_back({static_cast<float>(i), 0.5f, -static_cast<float>(i) / 8});
  }
  return positions;
}

std::string ErrorOf(StreamReader* reader, const std::string& datagram) {
  std::vector<CaptureFrame> frames;
  const absl::Status status = reader->Read(datagram, &frames);
  EXPECT_THAT(frames, IsEmpty());
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  return std::string(status.message());
}

TEST(XsensReaderTest, ReadsSegmentsWithYUp) {
  test::XsensFrame frame;
  frame.time_code_ms = 1250;
  frame.positions = SomePositions(XsensReader::kSegments);
  frame.positions[2] = {1, 2, 3};
  XsensReader reader;
  std::vector<CaptureFrame> frames;
  ASSERT_TRUE(reader.Read(test::XsensDatagram(frame), &frames).ok());
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(frames[0].sender_seconds, 1.25);
  ASSERT_THAT(frames[0].positions, SizeIs(reader.joint_names().size()));
  EXPECT_EQ(frames[0].positions[2], (motion::Vec3{1, 3, -2}));
  EXPECT_EQ(test::XsensDatagram(frame).size(), 760u);  // as the specification says
}

TEST(XsensReaderTest, ASampleMaySpanDatagrams) {
  test::XsensFrame first, rest;
  first.sample = rest.sample = 7;
  first.positions = SomePositions(10);
  rest.positions = SomePositions(13);
  rest.first_segment = 11;
  XsensReader reader;
  std::vector<CaptureFrame> frames;
  ASSERT_TRUE(reader.Read(test::XsensDatagram(rest), &frames).ok());
  EXPECT_THAT(frames, IsEmpty());
  ASSERT_TRUE(reader.Read(test::XsensDatagram(first), &frames).ok());
  EXPECT_THAT(frames, SizeIs(1));
  first.sample = 8;  // the other half of another sample does not complete it
  ASSERT_TRUE(reader.Read(test::XsensDatagram(first), &frames).ok());
  rest.sample = 9;
  ASSERT_TRUE(reader.Read(test::XsensDatagram(rest), &frames).ok());
  EXPECT_THAT(frames, SizeIs(1));
}

TEST(XsensReaderTest, ATimeCodeThatStandsStillIsNoTime) {
  XsensReader reader;
  std::vector<CaptureFrame> frames;
  for (uint32_t sample = 0; sample < 3; ++sample) {
    test::XsensFrame frame;
    frame.sample = sample;
    frame.positions = SomePositions(XsensReader::kSegments);
    ASSERT_TRUE(reader.Read(test::XsensDatagram(frame), &frames).ok());
  }
  ASSERT_THAT(frames, SizeIs(3));
  EXPECT_EQ(frames[2].sender_seconds, std::nullopt);
}

TEST(XsensReaderTest, TheFirstCharacterLeads) {
  test::XsensFrame frame;
  frame.character = 3;
  frame.positions = SomePositions(XsensReader::kSegments);
  XsensReader reader;
  std::vector<CaptureFrame> frames;
  ASSERT_TRUE(reader.Read(test::XsensDatagram(frame), &frames).ok());
  frame.character = 4;
  ASSERT_TRUE(reader.Read(test::XsensDatagram(frame), &frames).ok());
  EXPECT_THAT(frames, SizeIs(1));
  EXPECT_THAT(reader.TakeNotes(), ElementsAre(HasSubstr("character 3 leads")));
}

TEST(XsensReaderTest, RejectsOtherDatagrams) {
  XsensReader reader;
  test::XsensFrame frame;
  frame.positions = SomePositions(XsensReader::kSegments);
  frame.id = "MXTP01";
  EXPECT_THAT(ErrorOf(&reader, test::XsensDatagram(frame)),
              HasSubstr("select Position + Orientation (Quaternion)"));
  frame.id = "MXTP02";
  const std::string whole = test::XsensDatagram(frame);
  for (std::size_t size = 0; size < whole.size(); size += 5) {
    EXPECT_THAT(ErrorOf(&reader, whole.substr(0, size)), HasSubstr("expected"));
  }
  frame.positions[4].y = NAN;
  EXPECT_THAT(ErrorOf(&reader, test::XsensDatagram(frame)), HasSubstr("segment 5"));
}

class RokokoReaderTest : public ::testing::Test {
 protected:
  std::string Json(double seconds, const std::string& actor = "Ann") const {
    const auto& joints = reader_.joint_names();
    return test::RokokoJson(seconds, actor, joints, SomePositions(joints.size()));
  }

  RokokoReader reader_;
  std::vector<CaptureFrame> frames_;
};

TEST_F(RokokoReaderTest, ReadsPositionsInRightHandedAxes) {
  ASSERT_TRUE(reader_.Read(Json(2.5), &frames_).ok());
  ASSERT_THAT(frames_, SizeIs(1));
  EXPECT_EQ(frames_[0].sender_seconds, 2.5);
  EXPECT_EQ(frames_[0].positions[4], (motion::Vec3{-4, 0.5f, -0.5f}));
}

TEST_F(RokokoReaderTest, ReadsLz4Frames) {
  ASSERT_TRUE(reader_.Read(test::StoredLz4Frame(Json(2.5)), &frames_).ok());
  EXPECT_THAT(frames_, SizeIs(1));
}

TEST_F(RokokoReaderTest, TheFirstActorLeads) {
  ASSERT_TRUE(reader_.Read(Json(1), &frames_).ok());
  ASSERT_TRUE(reader_.Read(Json(2, "Bob"), &frames_).ok());
  ASSERT_TRUE(reader_.Read(Json(3), &frames_).ok());
  EXPECT_THAT(frames_, SizeIs(2));
  EXPECT_THAT(reader_.TakeNotes(), ElementsAre(HasSubstr("\"Ann\" leads")));
}

TEST_F(RokokoReaderTest, AnActorWithoutABodyDoesNotLead) {
  const std::string no_body =
      absl::StrReplaceAll(Json(1), {{"\"hasBody\":true", "\"hasBody\":false"}});
  ASSERT_TRUE(reader_.Read(no_body, &frames_).ok());
  EXPECT_THAT(frames_, IsEmpty());
}

TEST_F(RokokoReaderTest, NamesWhatIsWrong) {
  EXPECT_THAT(ErrorOf(&reader_, "no JSON"), HasSubstr("select the format JSON v3"));
  EXPECT_THAT(ErrorOf(&reader_, R"({"version":"3","trackers":[]})"),
              HasSubstr("scene.actors: expected a list, got none"));
  EXPECT_THAT(ErrorOf(&reader_, absl::StrReplaceAll(Json(1), {{"leftLeg", "leftlimb"}})),
              HasSubstr("body.leftLeg.position.x: expected a number within 1000 m, got none"));
  EXPECT_THAT(ErrorOf(&reader_, absl::StrReplaceAll(Json(1), {{"\"y\":0.5", "\"y\":1e9"}})),
              HasSubstr("body.hip.position.y"));
}

TEST_F(RokokoReaderTest, ToesThatAreMissingAreAtTheFeet) {
  const std::string text =
      absl::StrReplaceAll(Json(1), {{"leftToe", "leftTip"}, {"rightToe", "rightTip"}});
  ASSERT_TRUE(reader_.Read(text, &frames_).ok());
  ASSERT_TRUE(reader_.Read(text, &frames_).ok());
  ASSERT_THAT(frames_, SizeIs(2));
  const auto at = [this](const std::string& joint) {
    const std::vector<std::string>& names = reader_.joint_names();
    const auto found = std::find(names.begin(), names.end(), joint);
    return frames_[0].positions[static_cast<std::size_t>(found - names.begin())];
  };
  EXPECT_EQ(at("leftToe"), at("leftFoot"));
  EXPECT_EQ(at("rightToe"), at("rightFoot"));
  EXPECT_THAT(reader_.TakeNotes(), ElementsAre(HasSubstr("no toes")));
}

TEST_F(RokokoReaderTest, ATimestampThatIsNoNumberIsNoTime) {
  const std::string text =
      absl::StrReplaceAll(Json(7), {{"\"timestamp\":7", "\"timestamp\":\"\""}});
  ASSERT_TRUE(reader_.Read(text, &frames_).ok());
  ASSERT_THAT(frames_, SizeIs(1));
  EXPECT_EQ(frames_[0].sender_seconds, std::nullopt);
}

TEST(Lz4FrameTest, ReadsAFrameOfTheReferenceProgram) {
  const std::string bytes = base::BytesOfHex(kLz4Frame);
  std::string expected;
  for (int i = 0; i < 200; ++i) expected += "duet";
  const auto content = DecompressLz4Frame(bytes, 1000);
  ASSERT_TRUE(content.ok()) << content.status();
  EXPECT_EQ(*content, expected + "end");
}

TEST(Lz4FrameTest, RejectsContentAboveTheLimit) {
  const std::string bytes = base::BytesOfHex(kLz4Frame);
  EXPECT_TRUE(DecompressLz4Frame(bytes, 803).ok());
  EXPECT_THAT(std::string(DecompressLz4Frame(bytes, 802).status().message()),
              HasSubstr("at most 802 bytes"));
  EXPECT_FALSE(DecompressLz4Frame(test::StoredLz4Frame("12345"), 4).ok());
}

TEST(Lz4FrameTest, RejectsMatchesBeforeTheContent) {
  const auto frame = [](char distance) {
    std::string bytes(
        "\x04\x22\x4d\x18\x60\x70\x73\x06\0\0\0\x10"
        "a",
        13);
    bytes += distance;
    return bytes + std::string(
                       "\0\x10"
                       "z\0\0\0\0",
                       7);
  };
  EXPECT_EQ(DecompressLz4Frame(frame(1), 100).value(), "aaaaaz");
  for (const char distance : {'\0', '\2'}) {
    EXPECT_THAT(std::string(DecompressLz4Frame(frame(distance), 100).status().message()),
                HasSubstr("one before its start"));
  }
}

TEST(Lz4FrameTest, RejectsFramesCutAnywhere) {
  const std::string bytes = base::BytesOfHex(kLz4Frame);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(DecompressLz4Frame(bytes.substr(0, size), 1000).ok()) << size;
  }
}

TEST(CaptureAddressTest, ParsesHostsAndPorts) {
  const auto parse = [](const char* text) {
    const auto address = ParseCaptureAddress(text);
    return address.ok() ? FormatCaptureAddress(*address) : std::string(address.status().message());
  };
  EXPECT_EQ(parse("vmc://"), "vmc://:39539");
  EXPECT_EQ(parse("vmc://:5000"), "vmc://:5000");
  EXPECT_EQ(parse("xsens://10.0.0.1"), "xsens://10.0.0.1:9763");
  EXPECT_EQ(parse("rokoko://[::1]:9"), "rokoko://[::1]:9");
  EXPECT_EQ(parse("rokoko://localhost"), "rokoko://localhost:14043");
  EXPECT_THAT(parse("vmc://::1"), HasSubstr("in brackets"));
  EXPECT_THAT(parse("vmc://[::1"), HasSubstr("a bracket"));
  EXPECT_THAT(parse("vmc://host:70000"), HasSubstr("a port from 0 to 65535"));
  EXPECT_THAT(parse("vmc://host:"), HasSubstr("a port"));
  EXPECT_THAT(parse("osc://host"), HasSubstr("expected vmc://"));
}

TEST(CaptureAddressTest, FilesAreNoAddresses) {
  EXPECT_TRUE(IsCaptureAddress("vmc://"));
  EXPECT_FALSE(IsCaptureAddress("walk.bvh"));
  EXPECT_FALSE(IsCaptureAddress("vmc"));
}

}  // namespace
}  // namespace duet::client::capture
