// What a call of Synthesize costs its caller at the least: bare gRPC, one thread and one completion
// queue, replies parsed and dropped. What `duet batch` takes an item beyond this is its own
// (docs/batch.md). Prints one line of JSON.

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/channel.h"
#include "grpcpp/client_context.h"
#include "grpcpp/completion_queue.h"
#include "grpcpp/create_channel.h"
#include "grpcpp/security/credentials.h"
#include "grpcpp/support/async_stream.h"

namespace {

namespace v1 = duet::v1;

struct Options {
  std::string address;
  int calls = 20000;
  int in_flight = 64;
  int frames = 30;
};

double ProcessorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A made-up person who sways, in the joints of the default model.
v1::SynthesizeRequest Request(const v1::Model& model, int frames) {
  v1::SynthesizeRequest request;
  v1::Motion* const leader = request.mutable_leader();
  *leader->mutable_joint_names() = model.joint_names();
  leader->set_frame_rate_hz(model.frame_rate_hz());
  leader->set_unit(v1::LENGTH_UNIT_METRES);
  leader->set_up_axis(v1::UP_AXIS_Y_UP);
  leader->set_frame_count(static_cast<uint32_t>(frames));
  for (int value = 0; value < frames * model.joint_names_size() * 3; ++value) {
    leader->add_positions(0.3F * std::sin(0.1F * static_cast<float>(value)));
  }
  v1::ClassWeight* const weight = request.mutable_label_vector()->add_weights();
  weight->set_interaction_class(model.interaction_classes(0));
  weight->set_weight(1);
  request.set_priority(v1::PRIORITY_BULK);
  return request;
}

// A call that reads its reply to the end; the next step whenever its tag comes back.
class Call {
 public:
  Call(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request,
       grpc::CompletionQueue& queue) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(2));
    reader_ = stub.PrepareAsyncSynthesize(&context_, request, &queue);
    reader_->StartCall(this);
  }

  // Whether the call is over.
  bool Step(bool ok) {
    if (finishing_) return true;
    finishing_ = !ok;
    if (ok) {
      reader_->Read(&response_, this);
    } else {
      reader_->Finish(&status, this);
    }
    return false;
  }

  grpc::Status status;

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientAsyncReader<v1::SynthesizeResponse>> reader_;
  v1::SynthesizeResponse response_;
  bool finishing_ = false;
};

int Run(const Options& options) {
  const auto stub = v1::MotionSynthesis::NewStub(
      grpc::CreateChannel(options.address, grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  v1::GetModelResponse model;
  const grpc::Status known = stub->GetModel(&context, {}, &model);
  if (!known.ok()) {
    std::cerr << options.address << ": " << known.error_message() << "\n";
    return 1;
  }
  const v1::SynthesizeRequest request = Request(model.model(), options.frames);
  grpc::CompletionQueue queue;
  int started = 0, ended = 0, refused = 0;
  const double before = ProcessorSeconds();
  const auto start = std::chrono::steady_clock::now();
  while (started < std::min(options.in_flight, options.calls)) {
    new Call(*stub, request, queue);
    ++started;
  }
  void* tag = nullptr;
  bool ok = false;
  while (ended < options.calls && queue.Next(&tag, &ok)) {
    std::unique_ptr<Call> call(static_cast<Call*>(tag));
    if (!call->Step(ok)) {
      (void)call.release();
      continue;
    }
    ++ended;
    refused += call->status.ok() ? 0 : 1;
    if (started == options.calls) continue;
    new Call(*stub, request, queue);
    ++started;
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << R"({"calls":)" << ended << R"(,"refused":)" << refused << R"(,"calls_per_second":)"
            << ended / seconds << R"(,"processor_us_per_call":)"
            << 1e6 * (ProcessorSeconds() - before) / ended << "}\n";
  queue.Shutdown();
  while (queue.Next(&tag, &ok)) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What a call costs its caller at the least"};
  Options options;
  app.add_option("server", options.address, "HOST:PORT")->required();
  app.add_option("--calls", options.calls)->check(CLI::PositiveNumber);
  app.add_option("--in-flight", options.in_flight)->check(CLI::PositiveNumber);
  app.add_option("--frames", options.frames, "of the leader")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}
