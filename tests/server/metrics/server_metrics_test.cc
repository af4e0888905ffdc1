#include "server/metrics/server_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "server/common/error_details.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::metrics {
namespace {

constexpr MethodInfo kSynthesize = {"duet.v1.MotionSynthesis", "Synthesize", "server_stream"};

CallRecord Record() {
  CallRecord record;
  record.method = kSynthesize;
  record.request_id = "a-request-id";
  record.model = "sbu";
  record.version = 3;
  record.priority = "interactive";
  record.frames = 300;
  record.first_chunk_seconds = 0.02;
  record.total_seconds = 0.3;
  return record;
}

// Whether the metrics have each of these lines.
void ExpectLines(ServerMetrics& metrics, const std::vector<std::string>& lines) {
  const std::string text = "\n" + metrics.Render();
  for (const std::string& line : lines) EXPECT_THAT(text, HasSubstr("\n" + line + "\n"));
}

TEST(ServerMetricsTest, CountsCallsAsGrpcDashboardsExpect) {
  ServerMetrics metrics;
  for (int i = 0; i < 4; ++i) metrics.CallStarted(kSynthesize);
  CallRecord record = Record();
  metrics.CallFinished(record);
  record.status = absl::CancelledError("gone");
  metrics.CallFinished(record);
  record.status = common::WithInfo(absl::ResourceExhaustedError("full"), common::kReasonQueueFull);
  metrics.CallFinished(record);
  const std::string labels =
      R"(grpc_method="Synthesize",grpc_service="duet.v1.MotionSynthesis",grpc_type="server_stream"})";
  ExpectLines(metrics, {"# TYPE grpc_server_handling_seconds histogram",
                        "grpc_server_started_total{" + labels + " 4",
                        R"(grpc_server_handled_total{grpc_code="OK",)" + labels + " 1",
                        R"(grpc_server_handled_total{grpc_code="Canceled",)" + labels + " 1",
                        R"(duet_calls_in_flight{method="Synthesize"} 1)",
                        R"(duet_refusals_total{reason="QUEUE_FULL"} 1)",
                        R"(duet_first_chunk_seconds_bucket{priority="interactive",le="0.01"} 0)",
                        R"(duet_first_chunk_seconds_bucket{priority="interactive",le="0.025"} 3)",
                        R"(duet_frames_total{model="sbu",version="3"} 900)"});
  EXPECT_THAT(metrics.Render(), Not(HasSubstr("a-request-id"))) << "no text of a caller";
  EXPECT_THAT(metrics.Render(), Not(HasSubstr(R"(duet_refusals_total{reason=""})")));
}

TEST(ServerMetricsTest, CountsWindowsAndEachBatchOnce) {
  ServerMetrics metrics;
  metrics.BatchFinished({0, 0.04, 16});
  metrics.WindowFinished(batching::Priority::kBulk, {0.2, 0.04, 16, 720});
  metrics.WindowFinished(batching::Priority::kBulk, {0.2, 0, 0});
  ExpectLines(metrics, {R"(duet_computed_frames_total{priority="bulk"} 720)",
                        R"(duet_queue_seconds_count{priority="bulk"} 2)",
                        R"(duet_windows_dropped_total{priority="bulk"} 1)",
                        "duet_compute_seconds_count 1", "duet_compute_seconds_sum 0.04",
                        "duet_batch_size_count 1", "duet_batch_size_sum 16"});
}

TEST(ServerMetricsTest, CountsOnlyCallsOfListedCallers) {
  ServerMetrics metrics;
  CallRecord record = Record();
  record.caller = "stranger-7";
  metrics.CallFinished(record);
  record.caller = "studio";
  record.caller_is_listed = true;
  metrics.CallFinished(record);
  ExpectLines(metrics, {R"(duet_caller_calls_total{caller="studio",grpc_code="OK"} 1)"});
  EXPECT_THAT(metrics.Render(), Not(HasSubstr("stranger-7")));
}

TEST(ServerMetricsTest, ReportsCapacityBuildAndTheQueueAtEveryScrape) {
  ServerMetrics metrics;
  metrics.Describe("1.2.3", 128, 64, 2);
  double length = 3;
  ReadValues read;
  read.queued_windows = [&] { return length; };
  metrics.SetRead(std::move(read));
  ExpectLines(metrics, {"duet_max_calls 128", "duet_max_queued_windows 64", "duet_workers 2",
                        R"(duet_build_info{version="1.2.3"} 1)", "duet_queued_windows 3"});
  length = 5;
  ExpectLines(metrics, {"duet_queued_windows 5"});
}

TEST(ServerMetricsTest, ReadsModelsAtEveryScrape) {
  ServerMetrics metrics;
  const auto served = [](const std::string& name, int version, bool is_default) {
    engine::ModelDescription description = test::FakeDescription();
    description.name = name;
    description.version = version;
    return registry::ServedModel{
        std::make_shared<test::FakeSynthesizer>(description), {}, is_default};
  };
  std::vector<registry::ServedModel> models = {served("sbu", 3, true), served("k3hi", 1, false)};
  ReadValues read;
  read.models = [&] { return models; };
  metrics.SetRead(std::move(read));
  EXPECT_THAT(metrics.Render(),
              HasSubstr(R"(duet_model_info{model="sbu",version="3",default="true"} 1)"));
  models.erase(models.begin());
  const std::string text = metrics.Render();
  EXPECT_THAT(text, HasSubstr(R"(duet_model_info{model="k3hi",version="1",default="false"} 1)"));
  EXPECT_THAT(text, Not(HasSubstr(R"(duet_model_info{model="sbu")")));
}

TEST(ServerMetricsTest, ReportsCertificatesIfConfigured) {
  ServerMetrics metrics;
  EXPECT_THAT(metrics.Render(), Not(HasSubstr("duet_tls_certificate_expiry")));
  ReadValues read;
  read.certificate_end = [] { return 1900000000.0; };
  metrics.SetRead(std::move(read));
  metrics.SecretsReloaded("access", true);
  metrics.SecretsReloaded("tls", false);
  ExpectLines(metrics, {"duet_tls_certificate_expiry_timestamp_seconds 1900000000",
                        R"(duet_secrets_reloads_total{kind="access",outcome="taken"} 1)",
                        R"(duet_secrets_reloads_total{kind="tls",outcome="refused"} 1)",
                        R"(duet_secrets_last_reload_successful{kind="access"} 1)",
                        R"(duet_secrets_last_reload_successful{kind="tls"} 0)"});
}

// The value of a metric without labels.
double Value(const std::string& text, const std::string& metric) {
  const std::size_t at = text.find("\n" + metric + " ");
  if (at == std::string::npos) ADD_FAILURE() << "no " << metric;
  return at == std::string::npos ? -1 : std::stod(text.substr(at + metric.size() + 2));
}

TEST(ServerMetricsTest, ReportsTheProcess) {
  const std::string text = "\n" + ServerMetrics().Render();
  const double now = static_cast<double>(std::time(nullptr));
  EXPECT_GE(Value(text, "process_cpu_seconds_total"), 0);
  EXPECT_GT(Value(text, "process_start_time_seconds"), now - 86400);
  EXPECT_LT(Value(text, "process_start_time_seconds"), now + 5);
  EXPECT_GE(Value(text, "process_threads"), 1);
  EXPECT_GT(Value(text, "process_resident_memory_bytes"), 1e6);
  EXPECT_GE(Value(text, "process_virtual_memory_bytes"),
            Value(text, "process_resident_memory_bytes"));
  EXPECT_GE(Value(text, "process_open_fds"), 3);
  EXPECT_LT(Value(text, "process_open_fds"), Value(text, "process_max_fds"));
  EXPECT_THAT(text, HasSubstr("# TYPE process_cpu_seconds_total counter"));
}

TEST(ServerMetricsTest, ReportsServedCheckpoints) {
  ServerMetrics metrics;
  metrics.ModelLoaded("sbu/3", 1.5, true, true);
  metrics.ModelLoaded("sbu/4", 0.1, false, false);
  ExpectLines(metrics, {R"(duet_model_state{checkpoint="sbu/3"} 1)",
                        R"(duet_model_state{checkpoint="sbu/4"} 0)",
                        R"(duet_model_load_seconds{checkpoint="sbu/3"} 1.5)",
                        R"(duet_model_loads_total{result="ok"} 1)",
                        R"(duet_model_loads_total{result="refused"} 1)"});
  metrics.ModelLoaded("sbu/3", 0.1, false, true);
  ExpectLines(metrics, {R"(duet_model_state{checkpoint="sbu/3"} 1)",
                        R"(duet_model_last_load_successful{checkpoint="sbu/3"} 0)"});
  metrics.ModelLoaded("sbu/3", 1.5, true, true);
  metrics.ModelUnloaded("sbu/4");
  metrics.FoldersSkipped(2);
  metrics.Reloaded(false);
  ExpectLines(metrics, {R"(duet_model_last_load_successful{checkpoint="sbu/3"} 1)",
                        R"(duet_model_state{checkpoint="sbu/3"} 1)", "duet_model_folders_skipped 2",
                        R"(duet_reloads_total{result="failed"} 1)"});
  EXPECT_THAT(metrics.Render(), Not(HasSubstr("sbu/4")));
}

}  // namespace
}  // namespace duet::server::metrics
