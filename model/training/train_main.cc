// duet-train: trains a generator on a folder of captures and writes a checkpoint.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/base/status_macros.h"
#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/network/exceptions.h"
#include "model/training/options.h"
#include "model/training/run.h"

namespace {

namespace dataset = duet::dataset;
namespace training = duet::training;

struct Arguments {
  std::string data;
  std::string config = "default";
  std::string out;
  std::string name;  // empty: the name of the data set
  int version = 1;
  std::string description;
  std::string protocol = "all";
  std::string fold;
  std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
  std::vector<std::string> settings;
  std::string from;
  int threads = 1;
  std::string device = "cpu";
};

absl::StatusOr<std::string> ReadConfig(const std::string& config) {
  if (const training::NamedConfig* named = training::FindConfig(config)) {
    return std::string(named->json);
  }
  std::ifstream in(config, std::ios::binary);
  if (in) return std::string(std::istreambuf_iterator<char>(in), {});
  const std::string names = absl::StrJoin(
      training::NamedConfigs(), ", ",
      [](std::string* out, const training::NamedConfig& one) { out->append(one.name); });
  return absl::NotFoundError(absl::StrCat(
      "--config ", config, ": no such file, and no configuration of that name (", names, ")"));
}

absl::StatusOr<training::TrainingOptions> ReadOptions(const Arguments& arguments) {
  DUET_TRY(const std::string json, ReadConfig(arguments.config));
  std::vector<std::pair<std::string, std::string>> replacements;
  for (const std::string& setting : arguments.settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      return absl::InvalidArgumentError(
          absl::StrCat("--set ", setting, ": expected section.field=value"));
    }
    replacements.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  return training::ParseConfig(json, replacements);
}

// The runs of the protocol.
absl::StatusOr<std::vector<training::RunPlan>> Plans(const Arguments& arguments,
                                                     const training::TrainingOptions& options,
                                                     const dataset::Dataset& dataset) {
  training::RunPlan plan;
  plan.options = options;
  plan.model_name =
      arguments.name.empty() ? duet::checkpoint::ToPlainName(dataset.name) : arguments.name;
  plan.model_version = arguments.version;
  plan.description = arguments.description;
  plan.from = arguments.from;
  plan.device = arguments.device;
  std::vector<training::RunPlan> plans;
  const auto add = [&](const std::string& title, const std::string& folder,
                       const std::vector<int>& train) {
    plan.title = title;
    plan.folder = std::filesystem::path(arguments.out) / folder;
    plan.train = train;
    plans.push_back(plan);
  };
  if (arguments.protocol == "loso") {
    for (const std::string& subject : dataset.Subjects()) {
      if (!arguments.fold.empty() && subject != arguments.fold) continue;
      DUET_TRY(const dataset::Split split, LeaveSubjectOut(dataset, subject));
      add("without " + subject, subject, split.train);
    }
    // Says whom the data has.
    if (plans.empty()) return LeaveSubjectOut(dataset, arguments.fold).status();
  } else if (arguments.protocol == "half") {
    for (const uint64_t seed : arguments.seeds) {
      DUET_TRY(const dataset::Split split, SplitInHalves(dataset, seed));
      add(absl::StrCat("half ", seed), absl::StrCat("half-", seed), split.train);
    }
  } else {
    add("all", "all", AllSequences(dataset));
  }
  return plans;
}

absl::Status Train(const Arguments& arguments) {
  DUET_RETURN_IF_ERROR(training::SetTrainingThreads(arguments.threads));
  DUET_TRY(const training::TrainingOptions options, ReadOptions(arguments));
  DUET_TRY(const dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  for (const std::string& note : dataset.notes) std::cout << "assumed: " << note << "\n";
  DUET_TRY(const std::vector<training::RunPlan> plans, Plans(arguments, options, dataset));
  std::cout << "model: " << plans.front().model_name << " " << arguments.version << "\n";
  for (const training::RunPlan& plan : plans) {
    DUET_RETURN_IF_ERROR(
        training::RunTraining(plan, dataset, isatty(STDOUT_FILENO) != 0, &std::cout));
    std::cout << "checkpoint: " << training::CheckpointFolder(plan).string() << "\n";
  }
  return absl::OkStatus();
}

void Declare(Arguments* arguments, CLI::App* app) {
  app->add_option("--data", arguments->data, "folder of captures (docs/datasets.md)")->required();
  app->add_option("--out", arguments->out,
                  "folder of the run; a run that was killed resumes from it")
      ->required();
  app->add_option("--config", arguments->config, "named configuration, or JSON file")
      ->capture_default_str();
  app->add_option("--set", arguments->settings, "override a setting: section.field=value");
  app->add_option("--from", arguments->from,
                  "checkpoint folder whose weights the training begins with (default: random)");
  app->add_option("--name", arguments->name, "name of the model (default: that of the data set)");
  app->add_option("--version-number", arguments->version, "version of the model")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app->add_option("--description", arguments->description,
                  "description of the model, one sentence");
  app->add_option("--protocol", arguments->protocol,
                  "all: every sequence; loso: leave one subject out; half: half of each class")
      ->check(CLI::IsMember({"all", "loso", "half"}))
      ->capture_default_str();
  app->add_option("--fold", arguments->fold, "with loso: only this held-out subject");
  app->add_option("--seeds", arguments->seeds, "with half: one run, half-<seed>, per seed")
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--threads", arguments->threads, "number of LibTorch threads")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app->add_option("--device", arguments->device,
                  "cpu, or cuda with a LibTorch that supports it (sampling generators only)")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
}

int Run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Trains a generator on a folder of captures and writes a checkpoint.");
  app.set_version_flag("--version", "duet-train " DUET_VERSION);
  Declare(&arguments, &app);
  if (const std::optional<int> code = duet::base::ParseFlags(argc, argv, &app)) return *code;
  const absl::Status status =
      duet::network::CatchExceptions([&arguments] { return Train(arguments); });
  if (status.ok()) return 0;
  std::cerr << "duet-train: " << status.message() << "\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) { return duet::base::FinishOutput("duet-train", Run(argc, argv)); }
