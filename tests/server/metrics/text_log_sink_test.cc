#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/metrics/json_log.h"

namespace duet::server::metrics {
namespace {

TEST(TextLogSinkTest, PutsTimeSeverityAndEventFirst) {
  EXPECT_EQ(ToText(R"({"time":"2022-05-01T12:00:00Z","severity":"INFO","event":"call",)"
                   R"("method":"Synthesize","frames":300,"clean_up":true})"),
            "2022-05-01T12:00:00Z INFO    call method=Synthesize frames=300 clean_up=true");
}

TEST(TextLogSinkTest, QuotesAmbiguousValues) {
  EXPECT_EQ(ToText(R"({"time":"t","severity":"WARNING","event":"e","a":"two words","b":"x=y",)"
                   R"("c":"","d":"a\nb","e":"ü"})"),
            "t WARNING e a=\"two words\" b=\"x=y\" c=\"\" d=\"a\\nb\" e=\"ü\"");
}

TEST(TextLogSinkTest, DoesNotChangeOtherLines) {
  EXPECT_EQ(ToText("not JSON at all"), "not JSON at all");
  EXPECT_EQ(ToText("[1, 2]"), "[1, 2]");
}

TEST(TextLogSinkTest, PassesLinesToTheNextSink) {
  class Sink final : public LogSink {
   public:
    bool Write(std::string_view line) override {
      lines.emplace_back(line);
      return lines.size() == 1;
    }
    std::uint64_t dropped_lines() const override { return 3; }
    std::vector<std::string> lines;
  };
  const auto inner = std::make_shared<Sink>();
  TextLogSink sink(inner);
  EXPECT_TRUE(sink.Write(R"({"time":"t","severity":"ERROR","event":"e"})"));
  EXPECT_FALSE(sink.Write("lost"));
  EXPECT_EQ(inner->lines.at(0), "t ERROR   e");
  EXPECT_EQ(sink.dropped_lines(), 3u);
}

}  // namespace
}  // namespace duet::server::metrics
