#include "model/messages/message_text.h"

#include <gmock/gmock.h>
#include <google/protobuf/duration.pb.h>
#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace duet::messages {
namespace {

using test::IsOk;
using test::StatusIs;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ParseMessage, ReadsBothSyntaxesAndForgetsWhatWasThere) {
  google::protobuf::Duration message;
  message.set_nanos(7);
  ASSERT_THAT(ParseMessage("seconds: 3", MessageSyntax::kTextFormat, &message), IsOk());
  EXPECT_EQ(message.seconds(), 3);
  EXPECT_EQ(message.nanos(), 0);
  ASSERT_THAT(ParseMessage("\"5s\"", MessageSyntax::kJson, &message), IsOk());
  EXPECT_EQ(message.seconds(), 5);
}

TEST(ParseMessage, SaysWhereTheFirstErrorIs) {
  google::protobuf::Duration message;
  EXPECT_THAT(ParseMessage("seconds: 3\nhours: 1\ndays: 1", MessageSyntax::kTextFormat, &message),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       ::testing::AllOf(StartsWith("line 2:6: "), HasSubstr("hours"))));
  EXPECT_THAT(ParseMessage("{", MessageSyntax::kJson, &message),
              StatusIs(absl::StatusCode::kInvalidArgument, ::testing::_));
}

}  // namespace
}  // namespace duet::messages
