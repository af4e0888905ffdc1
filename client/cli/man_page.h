#ifndef DUET_CLIENT_CLI_MAN_PAGE_H_
#define DUET_CLIENT_CLI_MAN_PAGE_H_

#include <filesystem>
#include <string>

#include "CLI/CLI.hpp"
#include "absl/status/status.h"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// The manual page of a command in man(7)'s markup, of the program itself where `command` is empty;
// a usage error for an unknown one.
ParsedCommandLine PrintManualPage(const CLI::App& app, const std::string& command);

// Writes duet.1, duet-synthesize.1 and so on, by the name of the program, into a folder, which is
// made where it is not there.
absl::Status WriteManualPages(const CLI::App& app, const std::filesystem::path& folder);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MAN_PAGE_H_
