#include "server/tracing/otlp_client.h"

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/security/credentials.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "duet/otlp/v1/trace.pb.h"
#include "model/base/hex.h"
#include "server/common/http_origin.h"

namespace duet::server::tracing {
namespace {

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

class GrpcOtlpClient final : public OtlpClient {
 public:
  GrpcOtlpClient(std::shared_ptr<grpc::Channel> channel, std::string program_version)
      : stub_(std::move(channel)), program_version_(std::move(program_version)) {}

  absl::Status Send(const std::vector<Span>& spans) override {
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
    const grpc::Status status = answered.get_future().get();
    return absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  }

 private:
  grpc::TemplatedGenericStub<otlp::v1::ExportRequest, otlp::v1::ExportResponse> stub_;
  const std::string program_version_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<OtlpClient>> OtlpClient::Create(const std::string& endpoint,
                                                               const std::string& program_version) {
  const absl::StatusOr<common::HttpOrigin> origin = common::ParseHttpOrigin(endpoint);
  if (!origin.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("otlp_endpoint: ", origin.status().message()));
  }
  const auto credentials = origin->encrypted ? grpc::SslCredentials(grpc::SslCredentialsOptions())
                                             : grpc::InsecureChannelCredentials();
  return std::make_unique<GrpcOtlpClient>(
      grpc::CreateChannel(absl::StrCat("dns:///", origin->authority), credentials),
      program_version);
}

}  // namespace duet::server::tracing
