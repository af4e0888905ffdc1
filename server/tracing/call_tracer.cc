#include "server/tracing/call_tracer.h"

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/security/credentials.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "duet/otlp/v1/trace.pb.h"
#include "model/base/hex.h"
#include "server/common/http_origin.h"

namespace duet::server::tracing {
namespace {

// The codes that OpenTelemetry counts as errors of the server; the others are the caller's.
bool IsServersFault(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kUnimplemented:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDataLoss:
      return true;
    default:
      return false;
  }
}

constexpr char kExport[] = "/opentelemetry.proto.collector.trace.v1.TraceService/Export";
constexpr std::chrono::seconds kPatience(5);

void SetValue(const AttributeValue& value, otlp::v1::AnyValue& wire) {
  if (const auto* text = std::get_if<std::string>(&value)) wire.set_string_value(*text);
  if (const auto* number = std::get_if<std::int64_t>(&value)) wire.set_int_value(*number);
  if (const auto* number = std::get_if<double>(&value)) wire.set_double_value(*number);
  if (const auto* flag = std::get_if<bool>(&value)) wire.set_bool_value(*flag);
}

void Add(const std::string& key, const AttributeValue& value,
         google::protobuf::RepeatedPtrField<otlp::v1::KeyValue>& attributes) {
  otlp::v1::KeyValue& added = *attributes.Add();
  added.set_key(key);
  SetValue(value, *added.mutable_value());
}

void Fill(const Span& span, otlp::v1::Span& wire) {
  wire.set_trace_id(base::BytesOfHex(span.trace.trace_id));
  wire.set_span_id(base::BytesOfHex(span.trace.span_id));
  wire.set_parent_span_id(base::BytesOfHex(span.trace.parent_span_id));
  wire.set_name(span.name);
  wire.set_kind(otlp::v1::SPAN_KIND_SERVER);
  wire.set_start_time_unix_nano(static_cast<std::uint64_t>(span.start));
  wire.set_end_time_unix_nano(static_cast<std::uint64_t>(span.end));
  for (const auto& [key, value] : span.attributes) Add(key, value, *wire.mutable_attributes());
  for (const auto& [time, name] : span.events) {
    otlp::v1::Event& event = *wire.add_events();
    event.set_time_unix_nano(static_cast<std::uint64_t>(time));
    event.set_name(name);
  }
  if (!span.failed) return;
  wire.mutable_status()->set_code(otlp::v1::STATUS_CODE_ERROR);
  wire.mutable_status()->set_message(span.message);
}

// Sends spans to an OpenTelemetry collector: OTLP over gRPC.
//
// Threads: one thread at a time.
class OtlpClient {
 public:
  OtlpClient(std::shared_ptr<grpc::Channel> channel, std::string program_version)
      : stub_(std::move(channel)), program_version_(std::move(program_version)) {}

  // Waits at most a few seconds. Returns whether the collector took the spans.
  bool Send(const std::vector<Span>& spans) {
    otlp::v1::ExportRequest request;
    otlp::v1::ResourceSpans& ours = *request.add_resource_spans();
    Add("service.name", "duet-server", *ours.mutable_resource()->mutable_attributes());
    Add("service.version", program_version_, *ours.mutable_resource()->mutable_attributes());
    otlp::v1::ScopeSpans& scope = *ours.add_scope_spans();
    scope.mutable_scope()->set_name("duet.server");
    scope.mutable_scope()->set_version(program_version_);
    for (const Span& span : spans) Fill(span, *scope.add_spans());
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kPatience);
    otlp::v1::ExportResponse response;
    std::promise<grpc::Status> answered;
    stub_.UnaryCall(&context, kExport, grpc::StubOptions(), &request, &response,
                    [&answered](grpc::Status status) { answered.set_value(std::move(status)); });
    return answered.get_future().get().ok();
  }

 private:
  grpc::TemplatedGenericStub<otlp::v1::ExportRequest, otlp::v1::ExportResponse> stub_;
  const std::string program_version_;
};

}  // namespace

Span ToSpan(const metrics::CallRecord& record, absl::Time end) {
  Span span;
  span.trace = record.trace;
  span.name = std::string(record.method.service) + "/" + std::string(record.method.name);
  span.end = absl::ToUnixNanos(end);
  span.start = absl::ToUnixNanos(end - absl::Seconds(record.total_seconds));
  const auto add = [&span](const char* key, AttributeValue value) {
    span.attributes.emplace_back(key, std::move(value));
  };
  add("rpc.system", std::string("grpc"));
  add("rpc.service", std::string(record.method.service));
  add("rpc.method", std::string(record.method.name));
  add("rpc.grpc.status_code", static_cast<std::int64_t>(record.status.code()));
  add("duet.request_id", record.request_id);
  if (!record.caller.empty()) add("duet.caller", record.caller);
  if (!record.model.empty()) {
    add("duet.model", record.model);
    add("duet.version", std::int64_t{record.version});
  }
  if (!record.priority.empty()) {
    add("duet.priority", std::string(record.priority));
    add("duet.frames", std::int64_t{record.frames});
    add("duet.windows", std::int64_t{record.windows});
    add("duet.queue_seconds", record.queue_seconds);
    add("duet.compute_seconds", record.compute_seconds);
  }
  if (record.first_chunk_seconds >= 0) {
    span.events.emplace_back(
        span.start + absl::ToInt64Nanoseconds(absl::Seconds(record.first_chunk_seconds)),
        "first_chunk");
  }
  span.failed = IsServersFault(record.status.code());
  if (span.failed) span.message = std::string(record.status.message());
  return span;
}

absl::StatusOr<std::unique_ptr<CallTracer>> CallTracer::Open(const std::string& endpoint,
                                                             const std::string& program_version) {
  const absl::StatusOr<common::HttpOrigin> origin = common::ParseHttpOrigin(endpoint);
  if (!origin.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("otlp_endpoint: ", origin.status().message()));
  }
  const auto credentials = origin->encrypted ? grpc::SslCredentials(grpc::SslCredentialsOptions())
                                             : grpc::InsecureChannelCredentials();
  const auto collector = std::make_shared<OtlpClient>(
      grpc::CreateChannel(absl::StrCat("dns:///", origin->authority), credentials),
      program_version);
  SpanQueue::Options queue;
  queue.send = [collector](const std::vector<Span>& spans) { return collector->Send(spans); };
  return std::make_unique<CallTracer>(std::move(queue));
}

}  // namespace duet::server::tracing
