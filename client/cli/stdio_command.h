#ifndef DUET_CLIENT_CLI_STDIO_COMMAND_H_
#define DUET_CLIENT_CLI_STDIO_COMMAND_H_

#include "client/cli/exit_code.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// `duet stdio`: runs one command after another, so that a program that needs many starts one
// process. Reads `environment.in` line by line, each a JSON array with the words of a command:
//
//   ["convert", "walk.bvh", "--out", "-", "--output-format", "json", "--quiet"]
//
// and answers each line on `environment.out` before it reads the next: a line of JSON,
//
//   {"exit_code": 0, "out_bytes": 1234, "err_bytes": 0}
//
// then as many bytes of the command's standard output and standard error. A command has no standard
// input. A line that is no such array is answered with exit code 2. Returns kExitDone at the end of
// the input.
ExitCode RunStdio(const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_STDIO_COMMAND_H_
