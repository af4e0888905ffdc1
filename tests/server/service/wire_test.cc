#include "server/service/wire.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

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

TEST(ParseMessageTest, ReadsAMessageHoweverItIsSliced) {
  v1::SynthesizeRequest sent;
  sent.mutable_model()->set_name("walk");
  const std::string bytes = sent.SerializeAsString();
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    v1::SynthesizeRequest request;
    EXPECT_THAT(ParseMessage(Received({bytes.substr(0, cut), bytes.substr(cut)}), request), IsOk());
    EXPECT_EQ(request.model().name(), "walk");
  }
}

TEST(ParseMessageTest, RefusesEveryTruncation) {
  v1::SynthesizeRequest sent;
  sent.mutable_model()->set_name("walk");
  const std::string bytes = sent.SerializeAsString();
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    v1::SynthesizeRequest request;
    EXPECT_THAT(ParseMessage(Received({bytes.substr(0, size)}), request),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("SynthesizeRequest")))
        << size;
  }
}

}  // namespace
}  // namespace duet::server::service
