// duet-eval: measures trained models and baselines on captures.
#include <CLI/CLI.hpp>
#include <iostream>

#include "model/evaluation/program/commands.h"
#include "model/network/exceptions.h"
#include "model/torch_engine/torch_synthesizer.h"

int main(int argc, char** argv) {
  CLI::App app("Measures trained models and baselines on captures.");
  app.set_version_flag("--version", "duet-eval " DUET_VERSION);
  app.require_subcommand(1);
  duet::evaluation::program::ChosenCommand chosen;
  duet::evaluation::program::AddFoldsCommand(&app, &chosen);
  duet::evaluation::program::AddSamplesCommand(&app, &chosen);
  duet::evaluation::program::AddLongCommand(&app, &chosen);
  duet::evaluation::program::AddDanceCommand(&app, &chosen);
  duet::evaluation::program::AddPlausibleCommand(&app, &chosen);
  duet::evaluation::program::AddStripsCommand(&app, &chosen);
  duet::evaluation::program::AddToldApartCommand(&app, &chosen);
  duet::evaluation::program::AddSweepCommand(&app, &chosen);
  duet::evaluation::program::AddAugmentationCommand(&app, &chosen);
  duet::evaluation::program::AddLatentCommand(&app, &chosen);
  duet::evaluation::program::AddDataCommand(&app, &chosen);
  duet::evaluation::program::AddJudgeCommand(&app, &chosen);
  duet::evaluation::program::AddDirectionCommand(&app, &chosen);
  duet::evaluation::program::AddTiltCommand(&app, &chosen);
  duet::evaluation::program::AddLiveCommand(&app, &chosen);
  duet::evaluation::program::AddHourCommand(&app, &chosen);
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = duet::network::CatchExceptions([&chosen] {
    absl::Status prepared = duet::torch_engine::SetTorchThreads(1);
    return prepared.ok() ? chosen() : prepared;
  });
  if (status.ok()) return 0;
  std::cerr << "duet-eval: " << status.message() << "\n";
  return 1;
}
