#ifndef DUET_CONTRIB_LOAD_LOAD_PROGRAM_H_
#define DUET_CONTRIB_LOAD_LOAD_PROGRAM_H_

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace duet::contrib::load {

struct LoadEnvironment {
  std::ostream* out;
  std::ostream* err;
  std::function<bool()> stopped;  // whether to end the run early
};

// The exit codes, which --help explains.
enum ExitCode : int { kDone = 0, kNotAnswered = 1, kBadUsage = 2, kRejected = 42 };

// The whole `duet-load` program. Returns its exit code. `arguments` excludes the program's name.
int RunLoadProgram(const std::vector<std::string>& arguments, const LoadEnvironment& environment);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LOAD_PROGRAM_H_
