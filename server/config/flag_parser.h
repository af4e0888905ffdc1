#ifndef DUET_SERVER_CONFIG_FLAG_PARSER_H_
#define DUET_SERVER_CONFIG_FLAG_PARSER_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"

namespace CLI {
class App;
}  // namespace CLI

namespace duet::server::config {

// What the program is started for.
enum class Task {
  kServe,
  kCheckConfig,  // load everything, report every mistake, and exit
  kPrintConfig,  // print every setting and its source, and exit
  kCheckHealth,  // ask the running server whether it is healthy, and exit
};

// The values of flags.
struct Flags {
  v1::ServerConfig config;
  std::string config_path;
  Task task = Task::kServe;
};

// The program's flags: one for each setting, --config and the switches. Parses once, because CLI11
// keeps what it has parsed.
class FlagParser {
 public:
  FlagParser();
  ~FlagParser();
  FlagParser(const FlagParser&) = delete;
  FlagParser& operator=(const FlagParser&) = delete;

  // Parses a whole command line. `print` receives the text of --help and --version.
  // Fails with INVALID_ARGUMENT and the first mistake.
  absl::StatusOr<Flags> Parse(int argc, const char* const* argv, std::optional<std::string>* print);

  // Parses one flag of a command line with the words that follow it.
  // Fails with INVALID_ARGUMENT.
  absl::StatusOr<Flags> ParseOne(std::vector<std::string> words);

  // Parses an environment variable, whose value is spelled as on the command line.
  // Fails with INVALID_ARGUMENT.
  absl::StatusOr<Flags> ParseVariable(const std::string& name, const std::string& value);

 private:
  Flags flags_;
  const std::unique_ptr<CLI::App> app_;
};

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_FLAG_PARSER_H_
