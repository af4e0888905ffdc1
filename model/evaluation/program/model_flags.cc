#include "model/evaluation/program/model_flags.h"

#include "model/evaluation/program/section_flags.h"

namespace duet::evaluation::program {

void AddModelFlags(ModelNeeded needed, ModelChoice* models, CLI::App* command) {
  auto* source = command->add_option_group("model", "models to measure");
  source->add_option("--runs", models->runs, "output of duet-train --protocol loso; repeatable")
      ->type_name(kNamedRuns)
      ->allow_extra_args(false);
  source->add_option("--checkpoint", models->checkpoint, "one checkpoint folder for every fold")
      ->type_name(kCheckpoint);
  source->add_flag("--embedded", models->embedded, "the embedded checkpoint");
  source->require_option(needed == ModelNeeded::kYes ? 1 : 0, 1);
  AddAsServedFlag(models, command);
}

void AddAsServedFlag(ModelChoice* models, CLI::App* command) {
  command->add_flag("--as-served", models->as_served,
                    "finish the answers as a server does (default: the network's own answers)");
}

std::vector<std::string> StartNames() { return {"none", "root", "pose"}; }

experiments::StartGiven ParseStart(const std::string& name) {
  if (name == "root") return experiments::StartGiven::kRoot;
  return name == "pose" ? experiments::StartGiven::kPose : experiments::StartGiven::kNone;
}

std::string StartSuffix(experiments::StartGiven start) {
  if (start == experiments::StartGiven::kNone) return "";
  return start == experiments::StartGiven::kRoot ? "+root" : "+pose";
}

void AddStartsFlag(std::vector<std::string>* starts, CLI::App* command) {
  command
      ->add_option("--starts", *starts, "input about the follower's first frame; one row per value")
      ->delimiter(',')
      ->check(CLI::IsMember(StartNames()))
      ->capture_default_str();
}

void AddVarietyFlag(float* variety, CLI::App* command) {
  command
      ->add_option("--variety", *variety,
                   "variety of sampled answers; 0: the typical answer, 1: as varied as people")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
}

void AddSeedFlag(uint64_t* seed, CLI::App* command) {
  command->add_option("--seed", *seed, "seed of the answers")->capture_default_str();
}

void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command) {
  AddVarietyFlag(&asked->variety, command);
  command
      ->add_option("--candidates", asked->candidates,
                   "samples of each window, of which the best is taken")
      ->check(CLI::Range(1, engine::kMostCandidates))
      ->capture_default_str();
  AddSeedFlag(&asked->seed, command);
  command
      ->add_option(
          "--live", asked->live_delay,
          "answer as in a live session, this number of leader frames later; without it, the "
          "whole leader is known")
      ->type_name("FRAMES")
      ->check(CLI::Range(0, 10));
}

std::string LiveText(const experiments::AskedSamples& asked) {
  return asked.live_delay ? absl::StrCat(*asked.live_delay, " frames of delay") : "no";
}

void AddSamplingSettings(const experiments::AskedSamples& asked, report::ResultSection* section) {
  section->settings.insert(section->settings.end(), {{"variety", absl::StrCat(asked.variety)},
                                                     {"candidates", absl::StrCat(asked.candidates)},
                                                     {"seed", absl::StrCat(asked.seed)},
                                                     {"live", LiveText(asked)}});
}

}  // namespace duet::evaluation::program
