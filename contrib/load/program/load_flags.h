#ifndef DUET_CONTRIB_LOAD_PROGRAM_LOAD_FLAGS_H_
#define DUET_CONTRIB_LOAD_PROGRAM_LOAD_FLAGS_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/time/time.h"
#include "client/options.h"
#include "contrib/load/arrivals.h"
#include "contrib/load/call_kinds.h"
#include "contrib/load/live_options.h"
#include "contrib/load/load_options.h"
#include "contrib/load/measurement.h"

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11 has this name.
class App;
}  // namespace CLI

namespace duet::contrib::load::program {

// The server, and how to connect to it.
struct ServerArguments {
  std::string address = client::ClientOptions().server_address;
  double deadline_seconds = absl::ToDoubleSeconds(client::ClientOptions().deadline);
  bool tls = false;  // implied by each of the tls_ fields
  std::string tls_ca_file, tls_certificate_file, tls_key_file;
  std::string tls_server_name;
  std::string token_file;
  std::string authority;
};

// The arguments of duet-load.
struct LoadArguments {
  ServerArguments server;
  std::vector<int> callers;   // a step each; and
  std::vector<double> rates;  // a step each; neither: one caller
  ArrivalKind arrivals = ArrivalKind::kPoisson;
  CallMix mix;
  int connections = 1;
  int max_in_flight = LoadOptions().max_in_flight;
  double warm_up_seconds = 1;
  double seconds = 10;
  int64_t calls = 0;
  uint64_t seed = 0;
  int background_callers = 0;
  int background_frames = 9000;
  std::optional<client::ModelChoice> background_model;  // absent: as the measured calls
  std::vector<int> live;  // live sessions in place of calls; a step each
  LiveContent live_content;
  LiveConditions live_conditions;
  bool in_step = false;
  std::vector<std::filesystem::path> leaders;  // of live sessions; none: generated
  std::string title;
  std::filesystem::path csv, json, html, records;
  bool quiet = false;

  std::vector<Step> Steps() const;
  // Frames a second of live sessions.
  double LiveRate() const;
};

// Adds duet-load's flags. `arguments` outlives the app.
void AddLoadFlags(CLI::App* app, LoadArguments* arguments);

// The flags that were given, with their values.
std::vector<std::pair<std::string, std::string>> GivenFlags(const CLI::App& app);

// The client options for these flags. Reads the files of certificates and the token. Errors: those
// of reading a file; INVALID_ARGUMENT for an empty one.
absl::StatusOr<client::ClientOptions> ToClientOptions(const ServerArguments& arguments);

// "46=9,460": lengths with their weights (default 1). Errors: INVALID_ARGUMENT.
absl::StatusOr<std::vector<Weighted<int>>> ParseFrames(absl::string_view text);
// "sbu=3,k3hi@1": the same of models.
absl::StatusOr<std::vector<Weighted<client::ModelChoice>>> ParseModels(absl::string_view text);

}  // namespace duet::contrib::load::program

#endif  // DUET_CONTRIB_LOAD_PROGRAM_LOAD_FLAGS_H_
