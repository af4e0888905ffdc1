#include <gmock/gmock.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "server/service/wire.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Refusal;

// In pieces of `block` bytes, as they come from the network.
absl::Status Survey(const std::string& bytes, int block = -1) {
  google::protobuf::io::ArrayInputStream stream(bytes.data(), static_cast<int>(bytes.size()),
                                                block);
  return SurveyMessage(stream, *v1::SynthesizeRequest::descriptor());
}

std::string Times(std::size_t count, const std::string& bytes) {
  std::string all;
  all.reserve(count * bytes.size());
  for (std::size_t i = 0; i < count; ++i) all += bytes;
  return all;
}

// Field `number`, length-delimited.
std::string Field(int number, const std::string& content) {
  std::string bytes(1, static_cast<char>(number << 3 | 2));
  for (std::size_t left = content.size();; left >>= 7) {
    bytes += static_cast<char>((left & 127) | (left > 127 ? 128 : 0));
    if (left <= 127) break;
  }
  return bytes + content;
}

TEST(WireSurveyTest, LetsARequestPass) {
  v1::SynthesizeRequest request = test::SampleRequest(300);
  for (uint32_t i = 0; i < 4096; ++i) {
    v1::LabelKeyframe& keyframe = *request.add_label_keyframes();
    keyframe.set_frame(i);
    for (const char* name : {"kick", "push", "hug", "punch", "shake_hands", "exchange_object"}) {
      test::AddWeight(*keyframe.mutable_label_vector(), name, 1);
    }
  }
  EXPECT_THAT(Survey(request.SerializeAsString()), IsOk());
  EXPECT_THAT(Survey(request.SerializeAsString(), 7), IsOk());
}

TEST(WireSurveyTest, NumbersMayComeOneByOne) {
  // leader.positions, not packed.
  EXPECT_THAT(Survey(Field(2, Times(kMaxValues + 1, std::string("\x35\0\0\0\0", 5)))), IsOk());
}

TEST(WireSurveyTest, TooManyValuesAreRejectedByTheNameOfTheirField) {
  const struct {
    const char* what;
    std::string bytes, field;
  } bombs[] = {
      {"keyframes", Times(262145, std::string("\x22\x02\x12\x00", 4)), "label_keyframes"},
      {"weights of keyframes",
       Times(1024, Field(4, Field(2, Times(513, std::string("\x0a\x00", 2))))),
       "label_keyframes.label_vector.weights"},
      {"weights", Field(3, Times(kMaxValues, std::string("\x0a\x00", 2))), "label_vector.weights"},
      {"joint names", Field(2, Times(kMaxValues, std::string("\x0a\x00", 2))),
       "leader.joint_names"},
      {"one message again and again", Times(kMaxValues + 1, std::string("\x12\x00", 2)), "leader"},
      {"unknown numbers", Times(kMaxValues + 1, std::string("\xf8\x06\x01", 3)), ""},
      {"unknown below", Field(2, Times(kMaxValues, std::string("\xf8\x06\x01", 3))), "leader"},
      {"unknown strings", Times(kMaxValues + 1, std::string("\xfa\x06\x00", 3)), ""},
      {"known of another type", Times(kMaxValues + 1, std::string("\x20\x01", 2)),
       "label_keyframes"}};
  for (const auto& bomb : bombs) {
    for (const int block : {-1, 4096}) {
      SCOPED_TRACE(bomb.what);
      const Refusal refusal = test::Decode(Survey(bomb.bytes, block));
      EXPECT_EQ(refusal.code, absl::StatusCode::kInvalidArgument);
      EXPECT_THAT(refusal.Fields(), ElementsAre(bomb.field));
      EXPECT_THAT(refusal.Of(bomb.field), HasSubstr("expected at most "));
    }
  }
}

TEST(WireSurveyTest, GroupsAreRejected) {
  for (const char* bytes : {"\xfb\x06\xfc\x06", "\x12\x04\xfb\x06\xfc\x06", "\x23\x24"}) {
    EXPECT_THAT(Survey(bytes), StatusIs(absl::StatusCode::kInvalidArgument,
                                        HasSubstr("expected no group, which proto3 does not have, "
                                                  "got a group")));
  }
}

TEST(WireSurveyTest, WhatIsNoMessageIsTheParsers) {
  for (const std::string& bytes :
       {std::string("\x0a\x7f"), std::string("\xff\xff\xff"), std::string("\xfc\x06"),
        std::string("\x0a\xff\xff\xff\xff\x0f")}) {
    EXPECT_THAT(Survey(bytes), IsOk());
  }
}

// A message as it comes, in these slices.
grpc::ByteBuffer Received(const std::vector<std::string>& parts) {
  std::vector<grpc::Slice> slices;
  for (const std::string& part : parts) slices.emplace_back(part);
  return {slices.data(), slices.size()};
}

// An empty message has no slice that a parser could back up into.
TEST(ParseMessageTest, AnEmptyMessageIsAMessage) {
  for (const std::vector<std::string>& parts :
       std::vector<std::vector<std::string>>{{}, {""}, {"", ""}}) {
    v1::SynthesizeRequest request;
    EXPECT_THAT(ParseMessage(Received(parts), request), IsOk()) << parts.size();
    EXPECT_EQ(request.ByteSizeLong(), 0u);
  }
}

TEST(ParseMessageTest, ReadsAMessageHoweverItIsSlicedAndRefusesEveryTruncation) {
  v1::SynthesizeRequest sent;
  sent.mutable_model()->set_name("walk");
  const std::string bytes = sent.SerializeAsString();
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    v1::SynthesizeRequest request;
    EXPECT_THAT(ParseMessage(Received({bytes.substr(0, cut), bytes.substr(cut)}), request), IsOk());
    EXPECT_EQ(request.model().name(), "walk");
    if (cut == 0 || cut == bytes.size()) continue;
    request.Clear();
    EXPECT_THAT(ParseMessage(Received({bytes.substr(0, cut)}), request),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("SynthesizeRequest")));
  }
}

absl::Status ErrorOfLiveMessage(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  return ParseLiveMessage(grpc::ByteBuffer(&slice, 1)).status();
}

TEST(ParseLiveMessageTest, ATooLargeMessageIsNotParsed) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
  EXPECT_THAT(ErrorOfLiveMessage(std::string(kMaxBytes, '\0')),
              StatusIs(absl::StatusCode::kInvalidArgument, ::testing::_));
  EXPECT_THAT(ErrorOfLiveMessage(std::string(kMaxBytes + 1, '\0')),
              StatusIs(absl::StatusCode::kResourceExhausted,
                       HasSubstr("message of a live session: expected at most 1048576 bytes, got "
                                 "1048577")));
}

TEST(ParseLiveMessageTest, ManyTinyFieldsAreNotParsed) {
  // Label changes, each with a vector, each with an empty weight: four bytes that take 150 parsed.
  std::string bomb;
  for (int i = 0; i < 100'000; ++i) bomb.append("\x1a\x02\x12\x00", 4);
  EXPECT_THAT(ErrorOfLiveMessage(bomb),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("label_change")));
}

}  // namespace
}  // namespace duet::server::service
