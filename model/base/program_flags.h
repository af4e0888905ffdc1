#ifndef DUET_MODEL_BASE_PROGRAM_FLAGS_H_
#define DUET_MODEL_BASE_PROGRAM_FLAGS_H_

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <optional>

namespace duet::base {

// Parses a program's command line. Returns the exit code if the program should end: 0 after --help
// or --version, whose text goes to `out`, and 2 after an error, which goes to `err`.
std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app, std::ostream* out,
                              std::ostream* err);
// The same with the standard streams.
std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app);

// Accepts a number from `least` to `most`. CLI::Range alone accepts NaN too, because it only
// rejects what is less or more.
CLI::Validator InRange(int least, int most);
CLI::Validator InRange(double least, double most);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_PROGRAM_FLAGS_H_
