#include "server/service/motion_synthesis_service.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "duet/v1/model.pb.h"
#include "model/engine/live_synthesis.h"
#include "server/service/live_replies.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

registry::ModelQuery ToQuery(const v1::ModelSelector& selector) {
  registry::ModelQuery query;
  query.name = selector.name();
  if (selector.has_version()) query.version = selector.version();
  if (selector.has_version_label()) query.version_label = selector.version_label();
  return query;
}

v1::Model ToMessage(const registry::ServedModel& served) {
  const engine::ModelDescription& model = served.model->description();
  v1::Model message;
  message.set_name(model.name);
  message.set_version(static_cast<uint32_t>(model.version));
  for (const std::string& label : served.version_labels) message.add_version_labels(label);
  message.set_is_default(served.is_default);
  for (const std::string& name : model.classes) message.add_interaction_classes(name);
  for (const std::string& name : model.skeleton.joint_names) message.add_joint_names(name);
  for (const motion::Bone& bone : model.skeleton.bones) {
    v1::Bone* added = message.add_bones();
    added->set_parent_joint(static_cast<uint32_t>(bone.parent));
    added->set_child_joint(static_cast<uint32_t>(bone.child));
  }
  message.set_root_joint(model.skeleton.joint_names[static_cast<std::size_t>(model.skeleton.root)]);
  message.set_frame_rate_hz(model.frame_rate_hz);
  message.set_window_frames(static_cast<uint32_t>(model.window_frames));
  message.set_accepts_follower_start(model.accepts_follower_start);
  message.set_samples(model.samples);
  message.set_description(model.description);
  message.set_terms(model.terms);
  message.set_free_for_all_uses(model.free_for_all_uses);
  message.set_weights_sha256(model.weights_sha256);
  message.set_answers_live(engine::AnswersLive(model));
  return message;
}

v1::RequestLimits ToMessage(const RequestLimits& limits) {
  v1::RequestLimits message;
  message.set_min_frame_rate_hz(limits.min_frame_rate_hz);
  message.set_max_frame_rate_hz(limits.max_frame_rate_hz);
  message.set_min_frames(static_cast<uint32_t>(limits.min_frames));
  message.set_max_duration_seconds(limits.max_duration_seconds);
  message.set_max_chunk_frames(static_cast<uint32_t>(limits.max_chunk_frames));
  message.set_max_label_keyframes(static_cast<uint32_t>(limits.max_label_keyframes));
  message.set_max_abs_weight(limits.max_abs_weight);
  message.set_max_request_bytes(limits.max_request_bytes);
  message.set_max_variety(limits.max_variety);
  message.set_max_candidates(static_cast<uint32_t>(limits.max_candidates));
  message.set_max_delay_frames(static_cast<uint32_t>(limits.max_delay_frames));
  message.set_max_plan_frames(static_cast<uint32_t>(limits.max_plan_frames));
  message.set_max_constraints(static_cast<uint32_t>(limits.max_constraints));
  return message;
}

constexpr metrics::MethodInfo Info(std::string_view name, std::string_view type) {
  return {MotionSynthesisService::kServiceName, name, type};
}

constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

// Larger requests are handled on a separate thread, because parsing and validation take 8 ms per
// MiB. Their memory is returned to the system.
constexpr std::size_t kLargeRequestBytes = std::size_t{1} << 20;

// Far above ten seconds of two motions of any skeleton at any rate.
constexpr std::size_t kMaxLiveStartBytes = std::size_t{4} << 20;

// Returns a call's deadline on the scheduler's clock: the earlier one of the caller's and the
// server's.
common::TimePoint DeadlineOf(const grpc::ServerContextBase& context, const common::Clock& clock,
                             double max_seconds) {
  const double seconds = std::min(SecondsLeft(context), max_seconds);
  // More than ten days counts as no deadline, because the addition below may overflow.
  constexpr double kNever = 10 * 24 * 3600;
  if (seconds > kNever) return common::TimePoint::max();
  return clock.Now() + common::Seconds(seconds);
}

// The reply of a unary method.
template <typename Response>
class OneReply final : public ReplySource {
 public:
  explicit OneReply(Response reply) : reply_(std::move(reply)) {}

  absl::Status Start(SourceEvents) override { return absl::OkStatus(); }
  NextReply Next(metrics::CallRecord&) override {
    if (std::exchange(sent_, true)) return {nullptr, absl::OkStatus()};
    return {&reply_, {}};
  }
  void Cancel() override {}
  void Report(metrics::CallRecord&) const override {}

 private:
  const Response reply_;
  bool sent_ = false;
};

template <typename Response>
Call::Stream StreamOf(Response reply, ShareLease held_bytes) {
  Call::Stream stream;
  stream.source = std::make_shared<OneReply<Response>>(std::move(reply));
  stream.held_bytes = std::move(held_bytes);
  return stream;
}

}  // namespace

const MotionSynthesisService::Method MotionSynthesisService::kListModels = {
    Info("ListModels", "unary"), &MotionSynthesisService::PrepareList, kAnySize,
    /*takes_place=*/false, /*needs_room=*/false};
const MotionSynthesisService::Method MotionSynthesisService::kGetModel = {
    Info("GetModel", "unary"), &MotionSynthesisService::PrepareGet, kAnySize,
    /*takes_place=*/false, /*needs_room=*/false};
const MotionSynthesisService::Method MotionSynthesisService::kSynthesize = {
    Info("Synthesize", "server_stream"), &MotionSynthesisService::Prepare, kAnySize,
    /*takes_place=*/true, /*needs_room=*/true};
// A session has a place among the calls for as long as it lasts; its windows always join the queue.
const MotionSynthesisService::Method MotionSynthesisService::kSynthesizeLive = {
    Info("SynthesizeLive", "bidi_stream"), &MotionSynthesisService::PrepareLive, kMaxLiveStartBytes,
    /*takes_place=*/true, /*needs_room=*/false};

MotionSynthesisService::MotionSynthesisService(ServiceParts parts)
    : parts_(std::move(parts)),
      pipeline_(parts_.client_key, parts_.observers, *parts_.clock, parts_.access,
                security::Role::kSynthesise) {
  Serve("/duet.v1.MotionSynthesis/ListModels",
        [this](Context* context) { return Open(context, kListModels); });
  Serve("/duet.v1.MotionSynthesis/GetModel",
        [this](Context* context) { return Open(context, kGetModel); });
  Serve("/duet.v1.MotionSynthesis/Synthesize",
        [this](Context* context) { return Open(context, kSynthesize); });
  Serve("/duet.v1.MotionSynthesis/SynthesizeLive",
        [this](Context* context) { return Open(context, kSynthesizeLive); });
}

RawService::Reactor* MotionSynthesisService::Open(Context* context, const Method& method) {
  OpenedCall opened = pipeline_.Open(*context, method.info);
  auto* reactor = new CallReactor(*context, calls_);
  absl::Status admitted = opened.status;
  ShareLease place;
  if (admitted.ok() && method.takes_place) {
    absl::StatusOr<ShareLease> taken = parts_.admission->Admit(opened.client);
    admitted = taken.status();
    if (taken.ok()) place = *std::move(taken);
  } else if (admitted.ok()) {
    admitted = parts_.admission->CheckServing();
  }
  // Places and queue are checked before the request is read. The smaller shares of bulk calls are
  // checked afterwards, because the priority is in the request.
  if (admitted.ok() && method.needs_room) {
    const absl::Status room =
        parts_.scheduler->CheckRoom(batching::Priority::kInteractive, opened.client);
    if (!room.ok()) admitted = QueueRefusal(room);
  }
  if (!admitted.ok()) {
    place = ShareLease();  // free again before the caller knows
    reactor->Finish(*opened.scope, admitted);
    return reactor;
  }
  Call::Parts parts;
  parts.transport = reactor;
  parts.admission = parts_.admission;
  parts.clock = parts_.clock;
  parts.limits = parts_.reception;
  parts.scope = std::move(opened.scope);
  parts.client = std::move(opened.client);
  parts.place = std::move(place);
  const std::shared_ptr<Call> call = Call::Create(std::move(parts));
  calls_.Add(call);
  reactor->Receive(call, [this, context, &method](const std::shared_ptr<Call>& received_by,
                                                  grpc::ByteBuffer bytes) {
    Handle(method, {*context, received_by, std::move(bytes), {}, nullptr});
  });
  return reactor;
}

void MotionSynthesisService::Handle(const Method& method, Received received) {
  const std::size_t size = received.bytes.Length();
  const bool is_large = size >= kLargeRequestBytes;
  if (is_large) large_request_bytes_ += size;
  const std::size_t limit = parts_.limits.max_request_bytes;
  if (size > limit) return received.call->Refuse(TooLargeRefusal(size, limit));
  if (size > method.max_bytes) {
    return received.call->Refuse(LiveMessageTooLargeRefusal(size, method.max_bytes));
  }
  // A full server still describes its models.
  if (is_large || method.takes_place) {
    absl::StatusOr<ShareLease> held = parts_.admission->Hold(received.call->client(), size);
    if (!held.ok()) return received.call->Refuse(held.status());
    received.held = *std::move(held);
  }
  if (is_large) {
    HandleElsewhere(method, std::move(received));
  } else {
    Run(method, std::move(received));
  }
}

void MotionSynthesisService::HandleElsewhere(const Method& method, Received received) {
  if (parts_.transport != nullptr) {
    received.transport =
        std::make_shared<TransportQuota::Received>(*parts_.transport, received.bytes.Length());
  }
  // Shared, because the job is copied.
  auto waiting = std::make_shared<Received>(std::move(received));
  large_requests_.Post([this, &method, waiting = std::move(waiting)](bool run) {
    const std::shared_ptr<Call> call = waiting->call;
    const std::optional<absl::Status> ended = call->ended_meanwhile();
    if (run && !ended.has_value()) return Run(method, std::move(*waiting));
    waiting->held = ShareLease();  // free before the caller knows
    call->Refuse(ended.value_or(DrainingRefusal()));
  });
}

void MotionSynthesisService::Run(const Method& method, Received received) {
  const std::shared_ptr<Call> call = received.call;
  absl::StatusOr<Call::Stream> stream = (this->*method.prepare)(std::move(received));
  if (!stream.ok()) return call->Refuse(stream.status());
  stream->write_timeout_seconds = parts_.write_timeout_seconds;
  call->Run(*std::move(stream));
}

absl::Status MotionSynthesisService::Parse(Received& received, google::protobuf::Message& request) {
  absl::Status read = ParseMessage(std::move(received.bytes), request);
  received.transport = nullptr;
  return read;
}

// By value, so that everything is released if the call is refused.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
absl::StatusOr<Call::Stream> MotionSynthesisService::Prepare(Received received) {
  Call& call = *received.call;
  v1::SynthesizeRequest request;
  // A large request consists mostly of positions. Without the reservation, the array would grow by
  // doubling and exist twice each time.
  if (received.transport != nullptr) {
    const std::size_t positions = received.bytes.Length() / sizeof(float);
    request.mutable_leader()->mutable_positions()->Reserve(static_cast<int>(positions));
  }
  const absl::Status read = Parse(received, request);
  if (!read.ok()) return read;
  // The validator reports an unknown priority together with all other invalid fields.
  const batching::Priority priority =
      PriorityOf(request).value_or(batching::Priority::kInteractive);
  const absl::Status place = parts_.admission->CheckShare(priority);
  if (!place.ok()) return place;
  const absl::Status room = parts_.scheduler->CheckRoom(priority, call.client());
  if (!room.ok()) return QueueRefusal(room);
  absl::StatusOr<registry::ServedModel> served = FindModel(request.model());
  if (!served.ok()) return served.status();
  const engine::ModelDescription& model = served->model->description();
  absl::StatusOr<ValidatedRequest> validated = ValidateRequest(request, model, parts_.limits);
  if (!validated.ok()) return validated.status();
  SetCleanUp(model, validated->clip.options);
  ReplyParts parts = PartsOf(received, *served, parts_.max_call_seconds);
  Call::Stream stream;
  stream.held_bytes = std::move(received.held);
  stream.deadline = parts.deadline;
  stream.source = std::make_shared<ClipReplies>(std::move(parts), *std::move(validated));
  return stream;
}

absl::StatusOr<registry::ServedModel> MotionSynthesisService::FindModel(
    const v1::ModelSelector& selector, absl::string_view prefix) const {
  registry::FindResult found = parts_.registry->Find(ToQuery(selector));
  if (auto* not_found = std::get_if<registry::ModelNotFound>(&found)) {
    not_found->field.insert(0, prefix.data(), prefix.size());
    return ModelNotFoundRefusal(*not_found);
  }
  return std::get<registry::ServedModel>(std::move(found));
}

ReplyParts MotionSynthesisService::PartsOf(const Received& received,
                                           const registry::ServedModel& served,
                                           double max_seconds) const {
  ReplyParts parts;
  parts.model = served.model;
  parts.scheduler = parts_.scheduler;
  parts.clock = parts_.clock;
  parts.limits = parts_.limits;
  parts.deadline = DeadlineOf(received.context, *parts_.clock, max_seconds);
  parts.client = received.call->client();
  parts.buffered_frames = parts_.buffered_frames;
  parts.idle_seconds = parts_.live_idle_seconds;
  if (parts_.engine != nullptr) parts.engine = *parts_.engine;
  parts.server_version = parts_.version;
  return parts;
}

void MotionSynthesisService::SetCleanUp(const engine::ModelDescription& model,
                                        engine::SynthesisOptions& options) const {
  if (options.clean_up.has_value()) return;
  options.clean_up = parts_.clean_up.value_or(model.cleaned_up_by_default());
}

// The bytes are released before the session starts: the session keeps the history that it needs,
// and nothing else.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
absl::StatusOr<Call::Stream> MotionSynthesisService::PrepareLive(Received received) {
  v1::SynthesizeLiveRequest request;
  const absl::Status read = Parse(received, request);
  if (!read.ok()) return read;
  if (!request.has_start()) {
    return Malformed("payload", "start in the first message",
                     request.has_frames()         ? "frames"
                     : request.has_label_change() ? "label_change"
                                                  : "none");
  }
  absl::StatusOr<registry::ServedModel> served = FindModel(request.start().model(), "start.");
  if (!served.ok()) return served.status();
  const engine::ModelDescription& model = served->model->description();
  absl::StatusOr<ValidatedLiveStart> valid =
      ValidateLiveStart(std::move(*request.mutable_start()), model, parts_.limits);
  if (!valid.ok()) return valid.status();
  SetCleanUp(model, valid->live.options);
  // A session lasts as long as its caller wants.
  ReplyParts parts = PartsOf(received, *served, std::numeric_limits<double>::infinity());
  Call::Stream stream;
  stream.takes_messages = true;
  stream.deadline = parts.deadline;
  stream.source = std::make_shared<LiveReplies>(std::move(parts), *std::move(valid));
  return stream;
}

absl::StatusOr<Call::Stream> MotionSynthesisService::PrepareList(Received received) {
  v1::ListModelsRequest request;
  const absl::Status read = Parse(received, request);
  if (!read.ok()) return read;
  v1::ListModelsResponse response;
  for (const registry::ServedModel& served : parts_.registry->List()) {
    *response.add_models() = ToMessage(served);
  }
  return StreamOf(std::move(response), std::move(received.held));
}

absl::StatusOr<Call::Stream> MotionSynthesisService::PrepareGet(Received received) {
  v1::GetModelRequest request;
  const absl::Status read = Parse(received, request);
  if (!read.ok()) return read;
  const absl::StatusOr<registry::ServedModel> found = FindModel(request.model());
  if (!found.ok()) return found.status();
  v1::GetModelResponse response;
  *response.mutable_model() = ToMessage(*found);
  *response.mutable_limits() = ToMessage(parts_.limits);
  return StreamOf(std::move(response), std::move(received.held));
}

}  // namespace duet::server::service
