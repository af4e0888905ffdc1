#include "model/base/strict_json.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

using nlohmann::json;

auto Refused(const std::string& why) {
  return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why));
}

TEST(ParseStrictJson, RejectsWhatIsNotAnObject) {
  for (const char* text : {"", "[]", "1", " {}", "\xEF\xBB\xBF{}", "null"}) {
    EXPECT_THAT(ParseStrictJson(text, 3), Refused("first byte")) << text;
  }
}

TEST(ParseHandwrittenJson, SkipsByteOrderMarkAndWhiteSpace) {
  const absl::StatusOr<json> parsed = ParseHandwrittenJson("\xEF\xBB\xBF \r\n{\"a\": 1}", 3);
  ASSERT_THAT(parsed, IsOk());
  EXPECT_EQ((*parsed)["a"], 1);
  EXPECT_THAT(ParseHandwrittenJson(" x{}", 3), Refused("first byte"));
  EXPECT_THAT(ParseHandwrittenJson(" {\"a\": [[]]}", 2), Refused("deeper than 2"));
}

TEST(ParseStrictJson, RejectsBrokenJson) {
  for (const char* text : {"{", "{}}", "{} x", "{\"a\":}", "{\"a\":1,}", "{'a':1}", "{\"a\":01}",
                           "{\"a\":NaN}", "{\"a\":1e999}", "{\"a\":\"\xff\"}", "{/**/}"}) {
    EXPECT_THAT(ParseStrictJson(text, 3), Refused("not JSON")) << text;
  }
}

TEST(ParseStrictJson, RejectsTextBehindANul) {
  using std::string_literals::operator""s;
  EXPECT_THAT(ParseStrictJson("{}\0x"s, 3), Refused("NUL"));
  EXPECT_THAT(ParseStrictJson("{}\0"s, 3), Refused("NUL"));
}

TEST(ParseStrictJson, RejectsRepeatedKeysAtAnyLevel) {
  EXPECT_THAT(ParseStrictJson("{\"a\":1,\"a\":1}", 3), Refused("\"a\" is repeated"));
  EXPECT_THAT(ParseStrictJson("{\"x\":[{\"b\":1,\"b\":2}]}", 3), Refused("\"b\" is repeated"));
  // The same key, written in two ways.
  EXPECT_THAT(ParseStrictJson("{\"a\":1,\"\\u0061\":1}", 3), Refused("\"a\" is repeated"));
  // Equal keys of different objects are none.
  EXPECT_THAT(ParseStrictJson("{\"x\":{\"a\":1},\"y\":{\"a\":1},\"a\":1}", 3), IsOk());
}

TEST(ParseStrictJson, LimitsTheDepth) {
  EXPECT_THAT(ParseStrictJson("{\"a\":[[]]}", 3), IsOk());
  EXPECT_THAT(ParseStrictJson("{\"a\":[[[]]]}", 3), Refused("deeper than 3"));
  const std::string deep = "{\"a\":" + std::string(1000000, '[');
  EXPECT_THAT(ParseStrictJson(deep, 3), Refused("deeper than 3"));
}

class ObjectReaderTest : public ::testing::Test {
 protected:
  json object_ = json::parse(R"({"s": "text", "b": true, "i": 7, "n": 1.5, "list": ["x", "y"],
                                 "o": {}, "big": 18446744073709551615})");
  ObjectReader reader_{object_, "part"};
};

std::string ArrayOf(std::size_t values, const char* value) {
  std::string text = "{\"a\":[";
  for (std::size_t i = 0; i < values; ++i) absl::StrAppend(&text, i == 0 ? "" : ",", value);
  return text + "]}";
}

// Empty arrays take 3 bytes of text each and twenty times that once parsed.
TEST(ParseStrictJson, LimitsTheNumberOfValues) {
  EXPECT_THAT(ParseStrictJson(ArrayOf(kMaxJsonValues - 2, "0"), 3), IsOk());
  EXPECT_THAT(ParseStrictJson(ArrayOf(kMaxJsonValues, "[]"), 3),
              Refused("values: expected at most 2000000"));
}

TEST(ParseHandwrittenJson, DoesNotStoreSkippedFields) {
  const absl::StatusOr<json> parsed =
      ParseHandwrittenJson(ArrayOf(kMaxJsonValues + 1, "[]"), 3, {"a"});
  ASSERT_THAT(parsed, IsOk());
  EXPECT_EQ(*parsed, json({{"a", json::array()}}));
}

TEST_F(ObjectReaderTest, ReadsEveryType) {
  EXPECT_EQ(reader_.String("s", 4), "text");
  EXPECT_TRUE(reader_.Bool("b"));
  EXPECT_EQ(reader_.Int("i", 7, 7), 7);
  EXPECT_EQ(reader_.Number("n", 1.5, 1.5), 1.5);
  EXPECT_THAT(reader_.Strings("list", 2), ::testing::ElementsAre("x", "y"));
  EXPECT_THAT(reader_.Object("o"), IsEmpty());
  EXPECT_EQ(reader_.Number("big", 0, 1e20), 18446744073709551615.0);
  EXPECT_THAT(reader_.Finish(), IsOk());
}

TEST_F(ObjectReaderTest, NamesAnUnknownField) {
  for (const char* key : {"s", "b", "i", "n", "list", "o"}) reader_.Has(key);
  reader_.String("s", 9);
  EXPECT_THAT(reader_.Finish(), Refused("part: unknown field"));
}

TEST_F(ObjectReaderTest, KeepsTheFirstProblem) {
  reader_.Int("absent", 0, 9);
  reader_.String("i", 9);
  EXPECT_THAT(reader_.Finish(), Refused("absent"));
}

TEST_F(ObjectReaderTest, ChecksRanges) {
  constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
  ObjectReader too_big(object_, ""), too_small(object_, ""), wraps(object_, "");
  EXPECT_EQ(too_big.Int("i", 0, 6), 0);
  EXPECT_THAT(too_big.Finish(), Refused("i: expected a whole number from 0 to 6, got 7"));
  EXPECT_EQ(too_small.Int("i", 8, 9), 0);
  EXPECT_THAT(too_small.Finish(), Refused("i: expected a whole number from 8 to 9, got 7"));
  EXPECT_EQ(wraps.Int("big", -kMax, kMax), 0);
  EXPECT_THAT(wraps.Finish(), Refused(", got 18446744073709551615"));
  EXPECT_EQ(reader_.Number("n", 2, 3), 0);
  EXPECT_THAT(reader_.Finish(), Refused("n: expected a number from 2 to 3, got 1.5"));
}

TEST_F(ObjectReaderTest, ReadsUniqueStrings) {
  EXPECT_THAT(reader_.UniqueStrings("list", 2, 1), ::testing::ElementsAre("x", "y"));
  ASSERT_THAT(reader_.status(), IsOk());
  object_["list"].push_back("long");
  reader_.UniqueStrings("list", 3, 3);
  EXPECT_THAT(reader_.status(), Refused("list: expected at most 3 bytes, got a name of 4"));
  object_["list"][2] = "x";
  ObjectReader repeated(object_, "");
  repeated.UniqueStrings("list", 3, 3);
  EXPECT_THAT(repeated.status(), Refused("list: \"x\" is repeated"));
}

TEST(ObjectReader, RejectsOtherValuesThanObjects) {
  const json list = json::array({1, 2});
  ObjectReader reader(list, "part");
  EXPECT_EQ(reader.Int("x", 0, 1), 0);
  EXPECT_THAT(reader.Finish(), Refused("part: expected an object, got [1,2]"));
}

TEST(Shown, IsShort) {
  EXPECT_EQ(Shown("a\n"), "\"a\\n\"");
  EXPECT_EQ(Shown(1.5), "1.5");
  EXPECT_EQ(Shown(json::array({1, "x"})), "[1,\"x\"]");
  EXPECT_EQ(Shown(json(std::vector<int>(9, 1))), "an array of 9");
  EXPECT_LT(Shown(json::array({std::string(1000, 'x')})).size(), 80u);
}

std::optional<int> ParseDigit(absl::string_view text) {
  return text == "seven" ? std::optional<int>(7) : std::nullopt;
}

TEST(ObjectReader, ReadsAChoice) {
  const json object = {{"a", "seven"}, {"b", "eight"}, {"c", 7}};
  ObjectReader reader(object, "");
  EXPECT_EQ(reader.Choice("a", ParseDigit, "seven"), 7);
  EXPECT_THAT(reader.status(), IsOk());
  EXPECT_EQ(reader.Choice("b", ParseDigit, "seven"), 0);
  EXPECT_THAT(reader.status(), Refused("b: expected seven, got \"eight\""));
  ObjectReader mistyped(object, ""), missing(object, "");
  EXPECT_EQ(mistyped.Choice("c", ParseDigit, "seven"), 0);
  EXPECT_THAT(mistyped.status(), Refused("c: expected seven, got 7"));
  EXPECT_EQ(missing.Choice("d", ParseDigit, "seven"), 0);
  EXPECT_THAT(missing.status(), Refused("d: missing"));
}

}  // namespace
}  // namespace duet::base
