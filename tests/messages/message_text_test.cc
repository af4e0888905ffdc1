#include "model/messages/message_text.h"

#include <gmock/gmock.h>
#include <google/protobuf/api.pb.h>
#include <google/protobuf/duration.pb.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/matchers.h"

namespace duet::messages {
namespace {

TEST(ParseMessage, ReadsBothSyntaxesAndForgetsWhatWasThere) {
  google::protobuf::Duration message;
  message.set_nanos(7);
  ASSERT_THAT(ParseMessage("seconds: 3", MessageSyntax::kTextFormat, &message), IsOk());
  EXPECT_EQ(message.seconds(), 3);
  EXPECT_EQ(message.nanos(), 0);
  google::protobuf::Api api;
  api.set_version("1");
  ASSERT_THAT(ParseMessage("\xEF\xBB\xBF {\"name\": \"a\"}", MessageSyntax::kJson, &api), IsOk());
  EXPECT_EQ(api.name() + api.version(), "a");
}

TEST(ParseMessage, SaysWhereTheFirstErrorIs) {
  google::protobuf::Duration message;
  EXPECT_THAT(ParseMessage("seconds: 3\nhours: 1\ndays: 1", MessageSyntax::kTextFormat, &message),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       ::testing::AllOf(StartsWith("line 2:6: "), HasSubstr("hours"))));
  EXPECT_THAT(ParseMessage("{", MessageSyntax::kJson, &message),
              StatusIs(absl::StatusCode::kInvalidArgument, ::testing::_));
}

TEST(ParseMessage, AnErrorIsALineOfPrintableText) {
  google::protobuf::Api message;
  for (const MessageSyntax syntax : {MessageSyntax::kTextFormat, MessageSyntax::kJson}) {
    const std::string text = syntax == MessageSyntax::kJson ? "{\"a\x7f\": 1}" : "version: \x7f\r";
    const absl::Status status = ParseMessage(text, syntax, &message);
    EXPECT_THAT(status, StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("\\x7f")));
  }
}

// "line:column" of a field, or "nowhere".
std::string PlaceOf(const FieldPlaces& places, const std::string& field) {
  const auto place = places.find(field);
  if (place == places.end()) return "nowhere";
  return std::to_string(place->second.line) + ":" + std::to_string(place->second.column);
}

constexpr char kText[] = R"(name: "a"
  methods { name: "x" }
methods { name: "y" } source_context { file_name: "f" })";

TEST(ParseMessage, TellsWhereEachFieldIs) {
  google::protobuf::Api api;
  FieldPlaces places;
  ASSERT_THAT(ParseMessage(kText, MessageSyntax::kTextFormat, &api, &places), IsOk());
  EXPECT_EQ(PlaceOf(places, "name"), "1:1");
  EXPECT_EQ(PlaceOf(places, "methods[0]"), "2:3");
  EXPECT_EQ(PlaceOf(places, "methods[1]"), "3:1");
  EXPECT_EQ(PlaceOf(places, "source_context"), "3:23");
  EXPECT_EQ(PlaceOf(places, "version"), "nowhere");
}

TEST(ParseMessage, NamesTheFieldThatIsWrongInJson) {
  google::protobuf::Api api;
  const std::pair<const char*, const char*> cases[] = {
      {R"({"nam": "a"})", "nam"},
      {R"({"methods": [{"name": "x"}, {"request": "y"}]})", "methods[1]"},
      {R"({"syntax": "SYNTAX_PROTO9"})", "syntax"},
      {R"({"version": "1", "version": "2"})", "\"version\" is repeated"},
      {R"({"version": "1",})", "not JSON at byte 17"},
      {"[]", "not a JSON object"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(ParseMessage(text, MessageSyntax::kJson, &api),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)));
  }
}

TEST(ParseMessage, TellsEveryUnknownFieldOfTheTextFormat) {
  google::protobuf::Api api;
  EXPECT_THAT(
      ParseMessage("nam: \"a\"\nversion: \"1\"\nmethod { name: \"x\" }\nsyntax: 12345678901",
                   MessageSyntax::kTextFormat, &api),
      StatusIs(absl::StatusCode::kInvalidArgument,
               AllOf(StartsWith("line 1:4: "), HasSubstr("nam"), HasSubstr("\nline 3:8: "),
                     HasSubstr("\nline 4:"))));
  EXPECT_EQ(api.version(), "1");
}

}  // namespace
}  // namespace duet::messages
