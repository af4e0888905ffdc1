#include "client/cli/stdio_command.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

bool IsCommand(const json& words) {
  // A command that reads the same input would take the lines that follow.
  return words.is_array() && !words.empty() && words.front() != "stdio" &&
         std::all_of(words.begin(), words.end(), [](const json& word) { return word.is_string(); });
}

int RunLine(const std::string& line, const CommandContext& context,
            const ProgramEnvironment& environment) {
  const json words = json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (IsCommand(words)) {
    return context.run_program(words.get<std::vector<std::string>>(), environment);
  }
  *environment.err << "duet: stdio: expected a JSON array with the words of a command, such as "
                      "[\"models\", \"--json\"]\n";
  return kExitUsage;
}

ExitCode RunStdio(const CommandContext& context) {
  const ProgramEnvironment& environment = context.environment;
  if (environment.in == nullptr) return kExitDone;
  for (std::string line; std::getline(*environment.in, line);) {
    std::ostringstream out, err;
    ProgramEnvironment inner = environment;
    inner.out = &out;
    inner.err = &err;
    inner.in = nullptr;
    inner.out_is_terminal = inner.err_is_terminal = false;
    const int exit_code = RunLine(line, context, inner);
    const std::string printed = out.str(), errors = err.str();
    const json answer = {
        {"exit_code", exit_code}, {"out_bytes", printed.size()}, {"err_bytes", errors.size()}};
    *environment.out << answer.dump() << "\n" << printed << errors << std::flush;
  }
  return kExitDone;
}

}  // namespace

Command AddStdioCommand(FlagSet* program) {
  Command command;
  command.app =
      program->AddCommand("stdio", "Run commands read from standard input, for other programs");
  command.app->Footer(R"(
Each line of standard input is a JSON array with the words of a command. The answer to each line is
a line of JSON, followed by the command's standard output and standard error, whose numbers of bytes
the JSON states.

Example:
  echo '["convert", "walk.bvh", "--out", "-", "--output-format", "json"]' | duet stdio
)");
  command.run = RunStdio;
  return command;
}

}  // namespace duet::client::cli
