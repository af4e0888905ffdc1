#ifndef DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <functional>

#include "absl/status/status.h"

namespace duet::evaluation::program {

// The commands of duet-eval. Each adds itself and its flags to `app` and, if the command line names
// it, stores its action in `chosen`.
using ChosenCommand = std::function<absl::Status()>;

void AddFoldsCommand(CLI::App* app, ChosenCommand* chosen);         // figures of methods by class
void AddSamplesCommand(CLI::App* app, ChosenCommand* chosen);       // many answers to one leader
void AddPlausibleCommand(CLI::App* app, ChosenCommand* chosen);     // what a viewer notices
void AddToldApartCommand(CLI::App* app, ChosenCommand* chosen);     // from captured ones
void AddSweepCommand(CLI::App* app, ChosenCommand* chosen);         // label weights
void AddMixesCommand(CLI::App* app, ChosenCommand* chosen);         // mixes, negatives, reaction
void AddAugmentationCommand(CLI::App* app, ChosenCommand* chosen);  // the paper's Table 6
void AddLatentCommand(CLI::App* app, ChosenCommand* chosen);        // Figures 6 and 7
void AddJudgeCommand(CLI::App* app, ChosenCommand* chosen);         // tells whether classes differ

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_
