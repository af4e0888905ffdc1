// The ends of a live session that capture protocols are: a source and a sink.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "client/live/capture_source.h"
#include "client/live/vmc_sink.h"
#include "tests/support/test_motion.h"

namespace duet::client::live {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

LiveFrames ToFrames(const motion::Clip& clip, int first, int count) {
  LiveFrames frames;
  frames.first_frame = first;
  frames.poses = motion::Poses(clip.joint_count(), {clip.poses.frames(first, count).begin(),
                                                    clip.poses.frames(first, count).end()});
  return frames;
}

capture::CaptureAddress Address(int port) {
  return {capture::CaptureProtocol::kVmc, "127.0.0.1", port};
}

CaptureOptions Options(std::vector<std::string>* notes = nullptr) {
  CaptureOptions options;
  options.address = Address(0);
  options.frame_rate_hz = 30;
  options.skeleton = motion::SbuSkeleton();
  if (notes != nullptr) {
    options.on_note = [notes](const std::string& note) { notes->push_back(note); };
  }
  return options;
}

// What one end sends, the other one receives: the leader's joints are the follower's.
TEST(CaptureEndsTest, WhatASinkSendsASourceReceives) {
  std::vector<std::string> notes;
  const auto source = CaptureSource::Create(Options(&notes));
  ASSERT_TRUE(source.ok()) << source.status();
  const auto sink = VmcSink::Create(Address((*source)->port()));
  ASSERT_TRUE(sink.ok()) << sink.status();
  const motion::Clip person = test::MakePerson({});
  ASSERT_TRUE((*sink)->Start({person.joint_names, person.frame_rate_hz}).ok());
  // The datagrams wait in the socket's buffer, and are all read at once.
  ASSERT_TRUE((*sink)->Accept(ToFrames(person, 0, 20)).ok());
  ASSERT_TRUE((*sink)->Accept(ToFrames(person, 20, 10)).ok());
  const auto format = (*source)->Open();
  ASSERT_TRUE(format.ok()) << format.status();
  EXPECT_EQ(format->joint_names, person.joint_names);
  EXPECT_EQ(format->frame_rate_hz, 30);
  for (int n = 0; n < 29; ++n) {
    const auto event = (*source)->Next();
    ASSERT_TRUE(event.ok() && event->has_value());
    const auto& frame = std::get<LeaderFrame>(**event);
    EXPECT_EQ(frame.index, n);
    for (int joint = 0; joint < person.joint_count(); ++joint) {
      EXPECT_LT(Distance(frame.positions[static_cast<std::size_t>(joint)], person.at(n, joint)),
                0.01f)
          << n << " " << person.joint_names[static_cast<std::size_t>(joint)];
    }
  }
  EXPECT_THAT(notes, Contains(HasSubstr("waiting for frames at vmc://127.0.0.1:")));
  EXPECT_THAT((*sink)->Finish({}).value(), ElementsAre(HasSubstr("(30 frames)")));
  EXPECT_THAT((*source)->Notes(), Contains(HasSubstr(" frames")));
}

TEST(CaptureEndsTest, StopEndsOpenAndNext) {
  const auto source = CaptureSource::Create(Options());
  ASSERT_TRUE(source.ok()) << source.status();
  std::thread stopper([&] { (*source)->Stop(); });
  const absl::Status stopped = (*source)->Open().status();
  EXPECT_EQ(stopped.code(), absl::StatusCode::kCancelled) << "the server has no part in it";
  EXPECT_EQ(stopped.message(), "interrupted before the first frame: 0 frames");
  stopper.join();
  const auto event = (*source)->Next();
  ASSERT_TRUE(event.ok());
  EXPECT_FALSE(event->has_value());
}

TEST(CaptureEndsTest, AJointThatTheModelLacksIsNamed) {
  CaptureOptions options = Options();
  options.joints = {{"tail", "Hips"}};
  const auto source = CaptureSource::Create(options);
  ASSERT_TRUE(source.ok());
  const auto sink = VmcSink::Create(Address((*source)->port()));
  ASSERT_TRUE(sink.ok());
  const motion::Clip person = test::MakePerson({});
  ASSERT_TRUE((*sink)->Start({person.joint_names, 30}).ok());
  ASSERT_TRUE((*sink)->Accept(ToFrames(person, 0, 3)).ok());
  EXPECT_THAT(std::string((*source)->Open().status().message()), HasSubstr("\"tail\""));
}

TEST(VmcSinkTest, NeedsAHostAndVmc) {
  EXPECT_THAT(
      std::string(VmcSink::Create({capture::CaptureProtocol::kVmc, "", 39539}).status().message()),
      HasSubstr("expected vmc://HOST[:PORT], got vmc://:39539"));
  EXPECT_FALSE(VmcSink::Create({capture::CaptureProtocol::kXsens, "127.0.0.1", 9763}).ok());
}

}  // namespace
}  // namespace duet::client::live
