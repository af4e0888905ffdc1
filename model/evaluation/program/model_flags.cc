#include "model/evaluation/program/model_flags.h"

#include "absl/strings/str_cat.h"
#include "model/evaluation/program/named_runs.h"

namespace duet::evaluation::program {

void AddModelFlags(ModelNeeded needed, ModelChoice* models, CLI::App* command) {
  auto* source = command->add_option_group("model", "what to measure");
  source
      ->add_option("--runs", models->runs,
                   "[NAME=]DIR, output of duet-train --protocol loso; repeatable")
      ->allow_extra_args(false);
  source->add_option("--checkpoint", models->checkpoint, "one checkpoint folder for every fold");
  source->add_flag("--embedded", models->embedded, "the checkpoint inside this program");
  source->require_option(needed == ModelNeeded::kYes ? 1 : 0, 1);
  command->add_flag("--as-served", models->as_served,
                    "with what a server does to the answer (default: the network's own answer)");
}

std::string ModelWords(const ModelChoice& models) {
  std::string words;
  for (const std::string& text : models.runs) {
    const absl::StatusOr<NamedRuns> runs = ParseRuns(text);
    if (runs.ok()) absl::StrAppend(&words, " --runs ", runs->name, "=RUNS");
  }
  if (models.embedded) words += " --embedded";
  if (!models.checkpoint.empty()) words += " --checkpoint CHECKPOINT";
  if (models.as_served) words += " --as-served";
  return words;
}

void AddStartsFlag(std::vector<std::string>* starts, CLI::App* command) {
  command
      ->add_option("--starts", *starts,
                   "what a model is told of the follower's first frame, a row each")
      ->delimiter(',')
      ->check(CLI::IsMember(StartNames()))
      ->capture_default_str();
}

void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command) {
  command
      ->add_option("--variety", asked->variety,
                   "of a model that samples; 0: the typical answer, 1: as varied as people")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  command->add_option("--seed", asked->seed, "of the answers")->capture_default_str();
}

}  // namespace duet::evaluation::program
