#ifndef DUET_MODEL_EVALUATION_PROGRAM_MODEL_FLAGS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_MODEL_FLAGS_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/report/result_section.h"

// Flags that several commands share.

namespace duet::evaluation::program {

// Printed where ModelChoice::one_for_all applies.
inline constexpr char kOneForAll[] =
    "One checkpoint for every fold: it may have been trained on what is tested.";

// --runs, --checkpoint, --embedded, --as-served. Exactly one source of models, or at most one.
enum class ModelNeeded { kYes, kNo };
void AddModelFlags(ModelNeeded needed, ModelChoice* models, CLI::App* command);

// --as-served
void AddAsServedFlag(ModelChoice* models, CLI::App* command);

// Values of --starts: "none", "root" and "pose". ParseStart requires one of them.
std::vector<std::string> StartNames();
experiments::StartGiven ParseStart(const std::string& name);
// The suffix of a row's name: "", "+root", "+pose".
std::string StartSuffix(experiments::StartGiven start);

// --starts
void AddStartsFlag(std::vector<std::string>* starts, CLI::App* command);

// --variety
void AddVarietyFlag(float* variety, CLI::App* command);
// --seed
void AddSeedFlag(uint64_t* seed, CLI::App* command);
// --variety, --candidates, --seed, --live
void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command);

// Whether the answers are live, for a section's settings: "no", or the delay of the session.
std::string LiveText(const experiments::AskedSamples& asked);
// The values of AddSamplingFlags as settings of a section.
void AddSamplingSettings(const experiments::AskedSamples& asked, report::ResultSection* section);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_MODEL_FLAGS_H_
