#ifndef DUET_CLIENT_CLI_PROGRAM_H_
#define DUET_CLIENT_CLI_PROGRAM_H_

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/admin_client.h"
#include "client/cli/settings.h"
#include "client/cli/style.h"
#include "client/client.h"

namespace duet::client::cli {

// How the program reaches a server and where it prints; replaced in tests.
struct ProgramEnvironment {
  std::function<absl::StatusOr<Client>(const ClientOptions&)> connect;
  std::ostream* out;
  std::ostream* err;
  std::istream* in = nullptr;    // what `-` reads; none: there is nothing
  bool err_is_terminal = false;  // progress is shown in place, and with colour
  bool out_is_terminal = false;  // shown with colour
  Variables variables = [](const std::string&) { return std::nullopt; };
  std::function<absl::StatusOr<std::unique_ptr<AdminClient>>(const ClientOptions&)> connect_admin =
      AdminClient::Create;

  // Colour on a terminal, and never where NO_COLOR is set to anything.
  Style OutStyle() const { return Style(out_is_terminal && WantsColour()); }
  Style ErrStyle() const { return Style(err_is_terminal && WantsColour()); }

 private:
  bool WantsColour() const { return variables("NO_COLOR").value_or("").empty(); }
};

// The whole `duet` program: parses, calls, writes, prints. Returns its exit code
// (client/cli/exit_code.h). `arguments` come without the program's name.
int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_PROGRAM_H_
