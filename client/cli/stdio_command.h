#ifndef DUET_CLIENT_CLI_STDIO_COMMAND_H_
#define DUET_CLIENT_CLI_STDIO_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet stdio: runs one command after another, so that a program that needs many starts one
// process. Reads standard input line by line, each line a JSON array with the words of a command:
//
//   ["convert", "walk.bvh", "--out", "-", "--output-format", "json", "--quiet"]
//
// Answers each line on standard output before it reads the next one: a line of JSON,
//
//   {"exit_code": 0, "out_bytes": 1234, "err_bytes": 0}
//
// followed by that many bytes of the command's standard output and standard error. A command has no
// standard input. The answer to a line that is not such an array has exit code 2. At the end of the
// input the exit code is kExitDone.
Command AddStdioCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_STDIO_COMMAND_H_
