#ifndef DUET_TESTS_CLIENT_CLI_PROGRAM_RUNNER_H_
#define DUET_TESTS_CLIENT_CLI_PROGRAM_RUNNER_H_

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "client/cli/command.h"
#include "client/connection.h"
#include "gtest/gtest.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {

using Strings = std::vector<std::string>;

inline Strings operator+(Strings a, const Strings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A test that runs the whole program in a folder of its own, against a connection that a test
// scripts.
class ProgramRunner : public ::testing::Test {
 public:
  int Run(const Strings& arguments) {
    out_.str("");
    err_.str("");
    const ProgramEnvironment environment{
        [this](const ClientOptions& options) -> absl::StatusOr<Client> {
          options_ = options;
          if (connection_ != nullptr) return Client(connection_);
          return absl::UnavailableError("no server was expected");
        },
        &out_, &err_};
    return RunProgram(arguments, environment);
  }

  std::string out() const { return out_.str(); }
  std::string err() const { return err_.str(); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 protected:
  const test::TemporaryFolder folder_;
  std::shared_ptr<Connection> connection_;  // null: the program must not connect
  ClientOptions options_;                   // of the last connection

 private:
  std::ostringstream out_, err_;
};

}  // namespace duet::client::cli

#endif  // DUET_TESTS_CLIENT_CLI_PROGRAM_RUNNER_H_
