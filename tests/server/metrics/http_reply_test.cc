#include "server/metrics/http_reply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/matchers.h"

namespace duet::server::metrics {
namespace {

const HttpPages& Pages() {
  static const auto* const pages = new HttpPages{{"/page", [] {
                                                    return HttpPage{200, "text/plain", "hello\n"};
                                                  }}};
  return *pages;
}

std::string Reply(const std::string& request) { return HttpReply(request, Pages()).value_or(""); }

TEST(HttpReplyTest, WaitsForTheEndOfTheHead) {
  const std::string request = "GET /page HTTP/1.1\r\nHost: a\r\n\r\n";
  for (std::size_t i = 0; i < request.size(); ++i) {
    EXPECT_FALSE(HttpReply(request.substr(0, i), Pages()).has_value()) << i;
  }
  EXPECT_EQ(Reply(request),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 6\r\n"
            "Connection: close\r\n\r\nhello\n");
}

TEST(HttpReplyTest, DoesNotWaitForABody) {
  EXPECT_THAT(Reply("GET /page HTTP/1.1\r\nContent-Length: 99\r\n\r\nab"), EndsWith("hello\n"));
}

TEST(HttpReplyTest, IgnoresTheQuery) {
  EXPECT_THAT(Reply("GET /page?name[]=duet HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.1 200 OK"));
}

TEST(HttpReplyTest, HeadReplyHasTheLengthWithoutTheBody) {
  const std::string reply = Reply("HEAD /page HTTP/1.1\r\n\r\n");
  EXPECT_THAT(reply, HasSubstr("Content-Length: 6\r\n"));
  EXPECT_THAT(reply, Not(HasSubstr("hello")));
}

TEST(HttpReplyTest, RejectsInvalidRequestsWithTheMatchingCode) {
  EXPECT_THAT(Reply("GET /other HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 Not Found"));
  EXPECT_THAT(Reply("GET /pag HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 Not Found"));
  EXPECT_THAT(Reply("POST /page HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(Reply("POST /page HTTP/1.1\r\n\r\n"), HasSubstr("\r\nAllow: GET, HEAD\r\n"));
  EXPECT_THAT(Reply("GET /page HTTP/2.0\r\n\r\n"), StartsWith("HTTP/1.1 505"));
  EXPECT_THAT(Reply("GET /page\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Reply("\x16\x03 x HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Reply("\r\n\r\n"), StartsWith("HTTP/1.1 400"));
}

TEST(HttpReplyTest, RejectsAHeadThatIsTooLong) {
  EXPECT_FALSE(HttpReply(std::string(kMaxHttpHeadBytes, 'x'), Pages()).has_value());
  EXPECT_THAT(Reply(std::string(kMaxHttpHeadBytes + 1, 'x')), StartsWith("HTTP/1.1 431"));
}

}  // namespace
}  // namespace duet::server::metrics
