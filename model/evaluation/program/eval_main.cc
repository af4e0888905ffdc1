// duet-eval: measures trained models and baselines on captures.
#include <CLI/CLI.hpp>
#include <iostream>

#include "model/torch_engine/torch_synthesizer.h"
#include "model/evaluation/program/commands.h"

int main(int argc, char** argv) {
  CLI::App app("Measures trained models and baselines on captures.");
  app.require_subcommand(1);
  duet::ChosenCommand chosen;
  duet::AddFoldsCommand(&app, &chosen);
  duet::AddSweepCommand(&app, &chosen);
  duet::AddAugmentationCommand(&app, &chosen);
  duet::AddLatentCommand(&app, &chosen);
  duet::AddCurvesCommand(&app, &chosen);
  duet::AddValidationCommand(&app, &chosen);
  duet::AddReportCommand(&app, &chosen);
  CLI11_PARSE(app, argc, argv);
  duet::SetTorchThreads(1);
  const absl::Status status = chosen();
  if (status.ok()) return 0;
  std::cerr << "duet-eval: " << status.message() << "\n";
  return 1;
}
