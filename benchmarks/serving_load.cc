// Callers that ask a server for one follower after the other, or so many a second whatever becomes
// of them, and how long they waited. Some of them may ask for long clips in the background; they
// are not measured. Prints one line of JSON.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "client/client.h"

namespace {

using std::chrono::steady_clock;

struct Load {
  std::string address;
  duet::client::ModelChoice model;
  int callers = 1;
  double rate = 0;  // calls a second; 0: each caller asks again as soon as it is answered
  int frames = 45;
  int background_callers = 0;
  int background_frames = 9000;
  double warm_up_seconds = 1;
  double seconds = 5;
  double deadline_seconds = 120;
};

// What the measured callers saw.
struct Seen {
  std::mutex mutex;
  std::vector<double> seconds;  // of calls that were answered
  std::map<std::string, int> failed;
};

[[noreturn]] void Fail(const absl::Status& status) {
  std::cerr << status << "\n";
  std::exit(1);
}

duet::client::Client Connect(const Load& load, double deadline_seconds) {
  duet::client::ClientOptions options;
  options.server_address = load.address;
  options.deadline = absl::Seconds(deadline_seconds);
  options.retry.max_attempts = 1;
  absl::StatusOr<duet::client::Client> client = duet::client::Client::Create(options);
  if (!client.ok()) Fail(client.status());
  return *std::move(client);
}

// A made-up person who sways, in the joints and at the rate of the default model.
duet::client::SynthesisRequest Request(const duet::client::ModelInfo& model, int frames) {
  duet::client::SynthesisRequest request;
  request.leader.joint_names = model.joint_names;
  request.leader.frame_rate_hz = model.frame_rate_hz;
  const int joints = request.leader.joint_count();
  request.leader.poses = duet::motion::Poses(frames, joints);
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < joints; ++j) {
      const float phase = 0.2F * static_cast<float>(t) + static_cast<float>(j);
      request.leader.at(t, j) = {0.2F * std::sin(phase), 0.1F * static_cast<float>(j),
                                 0.2F * std::cos(phase)};
    }
  }
  request.weights = {{model.interaction_classes.front(), 1}};
  return request;
}

// When each call is to begin: calls take turns at one timetable, so that slow answers make no
// caller ask less. A call that begins late, as all callers were busy, has waited since its time.
class Timetable {
 public:
  Timetable(double rate, steady_clock::time_point begin) : rate_(rate), begin_(begin) {}
  steady_clock::time_point WaitForNext() {
    if (rate_ <= 0) return steady_clock::now();
    const auto time = begin_ + std::chrono::duration_cast<steady_clock::duration>(
                                   std::chrono::duration<double>(next_++ / rate_));
    std::this_thread::sleep_until(time);
    return time;
  }

 private:
  const double rate_;
  const steady_clock::time_point begin_;
  std::atomic<int> next_{0};
};

void Measure(const duet::client::Client& client, const duet::client::SynthesisRequest& request,
             Timetable& timetable, steady_clock::time_point begin, steady_clock::time_point end,
             Seen* seen) {
  while (steady_clock::now() < end) {
    const steady_clock::time_point start = timetable.WaitForNext();
    const absl::Status status = client.Synthesize(request).status();
    const steady_clock::time_point stop = steady_clock::now();
    if (stop < begin || stop >= end) continue;
    const std::lock_guard<std::mutex> lock(seen->mutex);
    if (status.ok()) {
      seen->seconds.push_back(std::chrono::duration<double>(stop - start).count());
    } else {
      ++seen->failed[absl::StatusCodeToString(status.code())];
    }
  }
}

// Long clips, one after the other, until `over`.
void KeepAsking(const duet::client::Client& client, const duet::client::SynthesisRequest& request,
                const std::atomic<bool>& over) {
  const auto go_on = [&](const duet::client::FollowerChunk&) {
    return over ? absl::CancelledError("over") : absl::OkStatus();
  };
  while (!over) {
    if (client.SynthesizeStreaming(request, go_on).ok() || over) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // refused
  }
}

double Percentile(const std::vector<double>& ascending, double part) {
  if (ascending.empty()) return 0;
  return ascending[static_cast<std::size_t>(part * static_cast<double>(ascending.size() - 1))];
}

void Print(const Load& load, Seen& seen) {
  std::sort(seen.seconds.begin(), seen.seconds.end());
  std::cout << "{\"clips_per_second\": " << static_cast<double>(seen.seconds.size()) / load.seconds
            << ", \"p50_ms\": " << 1000 * Percentile(seen.seconds, 0.5)
            << ", \"p99_ms\": " << 1000 * Percentile(seen.seconds, 0.99) << ", \"failed\": {";
  const char* separator = "";
  for (const auto& [code, count] : seen.failed) {
    std::cout << separator << "\"" << code << "\": " << count;
    separator = ", ";
  }
  std::cout << "}}\n";
}

void Run(const Load& load) {
  const duet::client::Client patient = Connect(load, 600);
  const duet::client::Client client = Connect(load, load.deadline_seconds);
  const absl::StatusOr<duet::client::ModelDetails> details = patient.GetModel(load.model);
  if (!details.ok()) Fail(details.status());
  duet::client::SynthesisRequest request = Request(details->model, load.frames);
  duet::client::SynthesisRequest background = Request(details->model, load.background_frames);
  request.model = background.model = load.model;
  std::atomic<bool> over{false};
  std::vector<std::thread> behind, measured;
  for (int i = 0; i < load.background_callers; ++i) {
    behind.emplace_back([&] { KeepAsking(patient, background, over); });
  }
  Seen seen;
  const auto after = [now = steady_clock::now()](double seconds) {
    return now + std::chrono::duration_cast<steady_clock::duration>(
                     std::chrono::duration<double>(seconds));
  };
  const steady_clock::time_point begin = after(load.warm_up_seconds);
  const steady_clock::time_point end = after(load.warm_up_seconds + load.seconds);
  Timetable timetable(load.rate, steady_clock::now());
  for (int i = 0; i < load.callers; ++i) {
    measured.emplace_back([&] { Measure(client, request, timetable, begin, end, &seen); });
  }
  for (std::thread& thread : measured) thread.join();
  over = true;
  for (std::thread& thread : behind) thread.join();
  Print(load, seen);
}

}  // namespace

int main(int argc, char** argv) {
  Load load;
  CLI::App app("Asks a server for followers and tells how long that took.", "serving_load");
  app.add_option("--server", load.address, "host:port")->required();
  app.add_option("--model", load.model.name, "the server's default unless told");
  app.add_option("--version", load.model.version, "of the model");
  app.add_option("--callers", load.callers, "calls at a time");
  app.add_option("--rate", load.rate, "calls a second, by as many callers as that takes");
  app.add_option("--frames", load.frames, "frames of each leader, at the model's rate");
  app.add_option("--background-callers", load.background_callers, "unmeasured calls at a time");
  app.add_option("--background-frames", load.background_frames, "frames of their leaders");
  app.add_option("--warm-up-seconds", load.warm_up_seconds, "not measured");
  app.add_option("--seconds", load.seconds, "measured");
  app.add_option("--deadline-seconds", load.deadline_seconds, "of each measured call");
  CLI11_PARSE(app, argc, argv);
  Run(load);
  return 0;
}
