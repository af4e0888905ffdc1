#include "model/base/json_events.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "gtest/gtest.h"
#include "model/base/random.h"
#include "tests/base/json_event_comparison.h"

namespace duet::base {
namespace {

using nlohmann::json;
using test::CompareJsonEvents;

const char* const kDocuments[] = {
    "{}",
    "[]",
    " [ ] ",
    "null",
    "\t{\"a\" : [ 1 , -2,0.5,\r\n\"x\" , true,false,null,[],{} ] } \n",
    R"({"a":{"b":[{"c":[[[]]]}],"d":{}},"e":[[1,2,3],[4,5,6]]})",
    R"(["a\"b\\c\/d\b\f\n\r\t","\u0041\u00e4\u20ac\ud83d\ude00","","\\"])",
    "[\"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\x7F\"]",
    R"({"\u0061":1,"b\n":2})",
};

const char* const kNumbers[] = {"0",
                                "-0",
                                "0.0",
                                "-0.0",
                                "1",
                                "-1",
                                "12.5",
                                "1e5",
                                "1E+5",
                                "1e-5",
                                "0.1",
                                "0.30000000000000004",
                                "123456789012345678",
                                "9007199254740993",
                                "-9007199254740993",
                                "9223372036854775807",
                                "-9223372036854775808",
                                "-9223372036854775809",
                                "18446744073709551615",
                                "18446744073709551616",
                                "1.7976931348623157e308",
                                "2.2250738585072014e-308",
                                "0.0000001",
                                "1e22",
                                "1e23",
                                "8.589973e9",
                                "179.76931348623157e306",
                                "3.4028235677973366e38",
                                "0.1000000000000000055511151231257827"};

const char* const kBroken[] = {"",
                               " ",
                               "{",
                               "}",
                               "[",
                               "]",
                               "[1",
                               "[1,",
                               "[1,]",
                               "[,1]",
                               "[1 2]",
                               "[}",
                               "{]",
                               "{} x",
                               "{}}",
                               "[]]",
                               "{\"a\"}",
                               "{\"a\":}",
                               "{\"a\":1,}",
                               "{,}",
                               "{a:1}",
                               "{'a':1}",
                               "{1:1}",
                               "[01]",
                               "[1.]",
                               "[.5]",
                               "[-]",
                               "[+1]",
                               "[1e]",
                               "[1e+]",
                               "[--1]",
                               "[0x1]",
                               "[1.5.5]",
                               "[NaN]",
                               "[inf]",
                               "[Infinity]",
                               "[-inf]",
                               "[nan]",
                               "[tru]",
                               "[truee]",
                               "[True]",
                               "[nul]",
                               "[1e999]",
                               "[-1e999]",
                               "[\"]",
                               "[\"\\\"]",
                               "[\"\\x\"]",
                               "[\"\\u12\"]",
                               "[\"\\ud800\"]",
                               "[\"\\udc00\\ud800\"]",
                               "[\"\n\"]",
                               "[\"\x01\"]",
                               "[\"\xff\"]",
                               "[\"\xC3\"]",
                               "[\"\xED\xA0\x80\"]",
                               "[\"\xC0\xAF\"]",
                               "/**/[]",
                               "[]//",
                               "\f[]",
                               "\"",
                               "\"\\"};

TEST(ReadJsonEvents, ReadsWhatTheLibraryReads) {
  for (const char* text : kDocuments) {
    EXPECT_TRUE(json::accept(text)) << text;
    EXPECT_EQ(CompareJsonEvents(text), "") << text;
  }
}

TEST(ReadJsonEvents, ReadsNumbersToTheBit) {
  for (const char* number : kNumbers) {
    const std::string text = absl::StrCat("[", number, "]");
    EXPECT_TRUE(json::accept(text)) << text;
    EXPECT_EQ(CompareJsonEvents(text), "") << text;
    EXPECT_EQ(CompareJsonEvents(number), "") << number;
  }
  Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    std::string text = random.Below(2) == 0 ? "-" : "";
    absl::StrAppend(&text, random.Below(1000), ".");
    for (int64_t digits = 1 + random.Below(20); digits > 0; --digits) {
      absl::StrAppend(&text, random.Below(10));
    }
    if (random.Below(4) == 0) absl::StrAppend(&text, "e", random.Below(600) - 300);
    ASSERT_EQ(CompareJsonEvents(text), "") << text;
  }
}

TEST(ReadJsonEvents, RejectsWhatTheLibraryRejects) {
  for (const char* text : kBroken) {
    EXPECT_FALSE(json::accept(text)) << absl::CHexEscape(text);
    EXPECT_EQ(CompareJsonEvents(text), "") << absl::CHexEscape(text);
  }
}

TEST(ReadJsonEvents, AgreesOnEveryPrefixAndEveryChangedByte) {
  for (const char* text : kDocuments) {
    const std::string document = text;
    for (std::size_t size = 0; size < document.size(); ++size) {
      EXPECT_EQ(CompareJsonEvents(document.substr(0, size)), "") << document.substr(0, size);
    }
    for (std::size_t at = 0; at < document.size(); ++at) {
      for (const char byte : {'[', ']', '{', '}', ',', ':', '"', '\\', '0', '-', '.', 'e', 't', ' ',
                              '\x01', '\xC3', '\x80'}) {
        std::string changed = document;
        changed[at] = byte;
        EXPECT_EQ(CompareJsonEvents(changed), "") << absl::CHexEscape(changed);
      }
    }
  }
}

// Stops at the event of a number.
class NoNumbers final : public nlohmann::json_sax<json> {
 public:
  int events = 0;

  bool null() override { return ++events > 0; }
  bool boolean(bool) override { return ++events > 0; }
  bool number_integer(number_integer_t) override { return false; }
  bool number_unsigned(number_unsigned_t) override { return false; }
  bool number_float(number_float_t, const string_t&) override { return false; }
  bool string(string_t&) override { return ++events > 0; }
  bool binary(binary_t&) override { return ++events > 0; }
  bool key(string_t&) override { return ++events > 0; }
  bool start_object(std::size_t) override { return ++events > 0; }
  bool start_array(std::size_t) override { return ++events > 0; }
  bool end_object() override { return ++events > 0; }
  bool end_array() override { return ++events > 0; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    ADD_FAILURE() << "parse_error";
    return false;
  }
};

TEST(ReadJsonEvents, StopsAtAnEventThatReturnsFalse) {
  for (const char* number : {"7", "-7", "7.5"}) {
    NoNumbers events;
    EXPECT_FALSE(ReadJsonEvents(absl::StrCat("{\"a\":[null,", number, ",null]}"), &events));
    EXPECT_EQ(events.events, 4) << number;
  }
  NoNumbers broken;
  EXPECT_FALSE(ReadJsonEvents("[nul", &broken));
}

TEST(ReadJsonEvents, DepthIsLimitedByMemoryOnly) {
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  NoNumbers events;
  EXPECT_TRUE(ReadJsonEvents(deep, &events));
  EXPECT_EQ(events.events, 2'000'000);
}

}  // namespace
}  // namespace duet::base
