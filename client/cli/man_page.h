#ifndef DUET_CLIENT_CLI_MAN_PAGE_H_
#define DUET_CLIENT_CLI_MAN_PAGE_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// The manual page of a command in man(7) markup; of the program itself if `command` is empty. Empty
// if there is no such command.
std::string ManualPage(const FlagSet& app, const std::string& command);

// Writes the pages of all commands into a folder, creating it if necessary. Files are named after
// the program: duet.1, duet-synthesize.1 and so on.
absl::Status WriteManualPages(const FlagSet& app, const std::filesystem::path& folder);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MAN_PAGE_H_
