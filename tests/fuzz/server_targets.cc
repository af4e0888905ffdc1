#include "tests/fuzz/server_targets.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/text_format.h>
#include <grpcpp/support/slice.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "duet/v1/synthesis.pb.h"
#include "model/base/request_id.h"
#include "model/engine/clip_synthesis.h"
#include "model/messages/message_text.h"
#include "server/config/load_config.h"
#include "server/security/secret_files.h"
#include "server/service/call_pipeline.h"
#include "server/service/reply_mapping.h"
#include "server/service/validator.h"
#include "server/service/wire.h"
#include "tests/fuzz/promises.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::fuzz {
namespace {

using server::service::ValidatedRequest;

constexpr std::size_t kOneSlice = std::size_t{32} << 20;
// Longer clips are validated only: answering them takes the time of many other inputs.
constexpr int kMostFramesAnswered = 64;
constexpr int kCores = 4;
constexpr char kSource[] = "input";

// Parses a request as the service does.
absl::Status Read(grpc::ByteBuffer bytes, v1::SynthesizeRequest& request) {
  // protobuf would write a line for each string that is not UTF-8; the server silences it as well.
  google::protobuf::SetLogHandler(nullptr);
  return server::service::ParseMessage(std::move(bytes), request);
}

// protobuf would write what is wrong with a text to standard error.
class SilentCollector final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int, google::protobuf::io::ColumnNumber, const std::string&) override {}
};

// The bytes as they come from the network, in slices of `slice_bytes`.
grpc::ByteBuffer Received(absl::string_view bytes, std::size_t slice_bytes) {
  std::vector<grpc::Slice> slices;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(slice_bytes, bytes.size()))) {
    slices.emplace_back(bytes.data(), std::min(slice_bytes, bytes.size()));
  }
  return {slices.data(), slices.size()};
}

// Answers a request by a model whose answer is known, and packs the reply as the service does.
Broken Answer(ValidatedRequest request) {
  const int frames = request.clip.leader.frame_count();
  if (frames > kMostFramesAnswered) return "";
  static const auto* const kModel = new test::FakeSynthesizer();
  engine::ClipSynthesis synthesis(kModel->description(), std::move(request.clip));
  int answered = 0;
  while (synthesis.HasNextWindow()) {
    const engine::SynthesisWindow window = synthesis.NextWindow();
    const engine::SynthesisWindow* const batch[] = {&window};
    engine::WindowResult result = std::move(kModel->Synthesize(batch).front());
    if (!result.ok()) return absl::StrCat("a good request fails: ", result.status().ToString());
    const motion::Poses poses = synthesis.Accept(*result);
    v1::MotionChunk chunk;
    AppendPositions(request.reply, poses, chunk.mutable_positions());
    if (!std::all_of(chunk.positions().begin(), chunk.positions().end(),
                     [](float value) { return std::isfinite(value); })) {
      return "an answer is not finite";
    }
    answered += poses.frame_count();
  }
  return answered == frames ? "" : absl::StrCat(frames, " frames got ", answered);
}

// What the service does with a request that is read.
Broken Handle(const v1::SynthesizeRequest& request) {
  absl::StatusOr<ValidatedRequest> validated =
      ValidateRequest(request, test::FakeDescription(), server::service::RequestLimits());
  if (validated.ok()) return Answer(*std::move(validated));
  return CheckRefusal(validated.status(),
                      {absl::StatusCode::kInvalidArgument, absl::StatusCode::kFailedPrecondition});
}

}  // namespace

Broken SynthesisRequest(absl::string_view input) {
  v1::SynthesizeRequest request, in_pieces;
  const absl::Status read = Read(Received(input, kOneSlice), request);
  const absl::Status pieces = Read(Received(input, 5), in_pieces);
  if (read != pieces) return "whether a request is read depends on how its bytes arrive";
  return read.ok() ? Handle(request) : CheckRefusal(read);
}

Broken SynthesisFields(absl::string_view input) {
  v1::SynthesizeRequest written;
  SilentCollector silence;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&silence);
  google::protobuf::io::ArrayInputStream text(input.data(), static_cast<int>(input.size()));
  if (!parser.Parse(&text, &written)) return "";
  v1::SynthesizeRequest request;
  const absl::Status read = Read(server::service::SerializeMessage(written), request);
  return read.ok() ? Handle(request) : CheckRefusal(read);
}

Broken ServerConfigText(absl::string_view input) {
  using messages::MessageSyntax;
  server::config::CommandLine line;
  const absl::Status read = messages::ParseMessage(input, MessageSyntax::kTextFormat, &line.config);
  if (!read.ok()) return CheckRefusal(read);
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(line, kCores);
  if (!options.ok()) return CheckRefusal(options.status());
  // What is printed is a configuration file that says the same.
  const std::string printed = server::config::PrintConfig(*options, {});
  line.config.Clear();
  if (!messages::ParseMessage(printed, MessageSyntax::kTextFormat, &line.config).ok()) {
    return absl::StrCat("a printed configuration is none: ", printed);
  }
  const absl::StatusOr<v1::ServerConfig> again = ResolveSettings(line, kCores);
  if (!again.ok()) return absl::StrCat("a printed configuration is refused: ", printed);
  return server::config::PrintConfig(*again, {}) == printed
             ? ""
             : "a printed configuration says something else";
}

Broken AccessFile(absl::string_view input) {
  const auto callers = server::security::ParseAccessList(Std(input), kSource);
  if (!callers.ok()) return CheckRefusal(callers.status());
  for (const server::security::Caller& caller : *callers) {
    if (caller.name.empty() || caller.roles.empty()) return "a caller has no name or no role";
    if (caller.token_digests.empty() && caller.certificate_names.empty()) {
      return "a caller is known by nothing";
    }
  }
  return "";
}

Broken CallMetadata(absl::string_view input) {
  std::vector<std::string> lines = absl::StrSplit(input, absl::MaxSplits('\n', 2));
  lines.resize(3);
  if (base::IsRequestId(lines[1]) && absl::StrContains(lines[1], ' ')) {
    return "a request id has blanks";
  }
  return server::service::ClientOf(lines[2]).size() > lines[2].size() + 64
             ? "a client's name outgrows its peer"
             : "";
}

}  // namespace duet::fuzz
