#ifndef DUET_SERVER_CONFIG_FLAG_NAMES_H_
#define DUET_SERVER_CONFIG_FLAG_NAMES_H_

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace duet::server::config {

// The arguments of a command line, without the program's name, for CLI::App::parse, with flags in
// their present spelling: "--max_calls=3", as they were once written, becomes "--max-calls=3" where
// `app` has such a flag. The old names so keep working without showing in --help.
std::vector<std::string> ArgumentsInKebabCase(const CLI::App& app, int argc,
                                              const char* const* argv);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_FLAG_NAMES_H_
