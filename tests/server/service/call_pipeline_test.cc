#include "server/service/call_pipeline.h"

#include <grpcpp/server_context.h>
#include <gtest/gtest.h>

#include <cstddef>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "tests/server/support/recording_observer.h"

namespace duet::server::service {
namespace {

using test::RecordingObserver;

// Notes how many calls had been reported when its call got a status.
struct NotingReactor {
  const RecordingObserver& observer;
  std::size_t reported = 0;
  grpc::Status status;

  void Finish(const grpc::Status& given) {
    status = given;
    reported = observer.records().size();
  }
};

TEST(CallPipelineTest, ReportsACallBeforeSendingItsStatus) {
  RecordingObserver observer;
  const std::vector<metrics::CallObserver*> observers = {&observer};
  CallScope scope({"service", "Method", "unary"}, {}, observers, common::Clock::Real());
  grpc::CallbackServerContext context;
  NotingReactor reactor{observer, 0, {}};
  CallPipeline::Close(scope, absl::NotFoundError("no such thing"), context, reactor);
  EXPECT_EQ(reactor.reported, 1u);
  EXPECT_EQ(reactor.status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(observer.records().front().status.code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace duet::server::service
