// duet-eval: measures trained models and baselines on captures.
#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>

#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/evaluation/program/experiment.h"
#include "model/network/exceptions.h"

namespace {

int Run(int argc, char** argv) {
  CLI::App app("Measures trained models and baselines on captures.");
  app.set_version_flag("--version", "duet-eval " DUET_VERSION);
  std::function<absl::Status()> chosen;
  duet::evaluation::program::AddCommands(&app, &chosen);
  if (const std::optional<int> code = duet::base::ParseFlags(argc, argv, &app)) return *code;
  const absl::Status status = duet::network::CatchExceptions([&chosen] {
    absl::Status prepared = duet::network::SetThreads(1);
    return prepared.ok() ? chosen() : prepared;
  });
  if (status.ok()) return 0;
  std::cerr << "duet-eval: " << status.message() << "\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) { return duet::base::FinishOutput("duet-eval", Run(argc, argv)); }
