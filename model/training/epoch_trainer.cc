#include "model/training/epoch_trainer.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"

namespace duet::training {
namespace {

// Version of the state file. 2: the generator's parameters are stacked.
constexpr int64_t kStateVersion = 2;

std::vector<torch::Tensor> Copies(const std::vector<torch::Tensor>& tensors) {
  std::vector<torch::Tensor> copies;
  for (const torch::Tensor& tensor : tensors) copies.push_back(tensor.detach().clone());
  return copies;
}

// The first line of an identity that is not that of a saved state.
std::string FirstDifference(const std::string& saved, const std::string& now) {
  const std::vector<std::string> before = absl::StrSplit(saved, '\n');
  const std::vector<std::string> after = absl::StrSplit(now, '\n');
  size_t i = 0;
  while (i + 1 < std::min(before.size(), after.size()) && before[i] == after[i]) ++i;
  const auto shown = [](absl::string_view line) {
    return absl::StripSuffix(absl::StripAsciiWhitespace(line), ",");  // of JSON
  };
  return absl::StrCat("expected ", shown(before[i]), ", got ", shown(after[i]));
}

void CopyInto(const std::vector<torch::Tensor>& from, const std::vector<torch::Tensor>& to) {
  torch::NoGradGuard no_grad;
  for (size_t i = 0; i < from.size(); ++i) torch::Tensor(to[i]).copy_(from[i]);
}

}  // namespace

EpochTrainer::EpochTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
                           const dataset::Dataset& dataset, std::vector<int> train,
                           std::vector<int> validation)
    : options_(options),
      manifest_(manifest),
      dataset_(dataset),
      train_(std::move(train)),
      validation_(std::move(validation)),
      best_afd_(std::numeric_limits<double>::infinity()) {}

void EpochTrainer::Begin(torch::nn::Module* generator) {
  generator_ = generator;
  average_ = Copies(generator->parameters());
  best_ = Copies(generator->parameters());
}

absl::Status EpochTrainer::UseDevice(const std::string& device) {
  if (device == "cpu") return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("device: expected cpu for the paper's generator, got ", device));
}

absl::Status EpochTrainer::StartFrom(const checkpoint::Checkpoint& checkpoint) {
  DUET_RETURN_IF_ERROR(LoadWeights(checkpoint));
  average_ = Copies(generator_->parameters());
  best_ = Copies(generator_->parameters());
  return absl::OkStatus();
}

void EpochTrainer::UpdateAverage(double decay) {
  torch::NoGradGuard no_grad;
  const std::vector<torch::Tensor> parameters = generator_->parameters();
  if (decay == 0) return CopyInto(parameters, average_);
  at::_foreach_mul_(average_, decay);
  at::_foreach_add_(average_, parameters, 1 - decay);
}

EpochReport EpochTrainer::RunEpoch() {
  const auto begin = std::chrono::steady_clock::now();
  EpochReport report;
  report.epoch = epoch_ + 1;
  report.epochs = options_.common.epochs();
  // Dropout uses LibTorch's random numbers. Seeding by epoch makes a resumed run draw the same.
  torch::manual_seed(options_.common.seed() * 1000003 + static_cast<uint64_t>(epoch_));
  generator_->train();
  TrainEpoch(epoch_ * steps_per_epoch(), &report);
  ++epoch_;
  report.validation_afd = Validate(StartKnowledge::kNone);
  report.validation_afd_pose = manifest_.model.accepts_follower_start
                                   ? Validate(StartKnowledge::kPose)
                                   : std::numeric_limits<double>::quiet_NaN();
  Choose(report.validation_afd);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

void EpochTrainer::Choose(double afd) {
  // Until an epoch may result, the last one stands in.
  const bool chooses = !validation_.empty() && MayBeBest(epoch_ - 1);
  if (chooses && !(afd < best_afd_)) return;
  if (chooses) best_afd_ = afd;
  best_epoch_ = epoch_;
  CopyInto(average_, best_);
}

double EpochTrainer::Validate(StartKnowledge start) {
  if (validation_.empty()) return std::numeric_limits<double>::quiet_NaN();
  torch::NoGradGuard no_grad;
  const std::vector<torch::Tensor> parameters = generator_->parameters();
  const std::vector<torch::Tensor> trained = Copies(parameters);
  CopyInto(average_, parameters);
  generator_->eval();
  double sum = 0;
  for (const int index : validation_) {
    sum += ValidationError(
        CapturedExample(dataset_, dataset_.sequences[static_cast<size_t>(index)], start));
  }
  CopyInto(trained, parameters);
  return sum / static_cast<double>(validation_.size());
}

void EpochTrainer::CopyBest(torch::nn::Module* generator) const {
  CopyInto(best_, generator->parameters());
  generator->eval();
}

// A saved state is only valid for a run with the same identity: settings, manifest and sequences.
std::string EpochTrainer::Identity() const {
  return absl::StrCat(absl::StrJoin(Describe(options_), "\n", absl::PairFormatter("=")), "\n",
                      SerializeManifest(manifest_), "data set: ", dataset_.name,
                      "\ntraining sequences: ", absl::StrJoin(train_, ","),
                      "\nvalidation sequences: ", absl::StrJoin(validation_, ","));
}

std::vector<std::pair<std::string, torch::Tensor>> EpochTrainer::StateTensors() {
  std::vector<std::pair<std::string, torch::Tensor>> state;
  const auto add = [&](const std::string& name, const std::vector<torch::Tensor>& tensors) {
    for (size_t i = 0; i < tensors.size(); ++i) {
      state.emplace_back(absl::StrCat(name, i), tensors[i].detach());
    }
  };
  add("generator", generator_->parameters());
  add("average", average_);
  add("best", best_);
  for (auto& named : MoreTensors()) state.push_back(std::move(named));
  return state;
}

absl::Status EpochTrainer::SaveState(const std::filesystem::path& file) {
  const std::filesystem::path temporary = file.string() + ".tmp";
  try {
    torch::serialize::OutputArchive archive;
    for (const auto& [name, tensor] : StateTensors()) archive.write(name, tensor);
    archive.write("version", c10::IValue(kStateVersion));
    archive.write("identity", c10::IValue(Identity()));
    archive.write("epoch", c10::IValue(epoch_));
    archive.write("best_epoch", c10::IValue(best_epoch_));
    archive.write("best_afd", c10::IValue(best_afd_));
    for (const auto& [name, optimiser] : StateOptimisers()) {
      torch::serialize::OutputArchive one;
      optimiser->save(one);
      archive.write(name, one);
    }
    archive.save_to(temporary.string());
    std::filesystem::rename(temporary, file);
  } catch (const std::exception& error) {
    return absl::InternalError(absl::StrCat(file.string(), ": cannot be written: ", error.what()));
  }
  return absl::OkStatus();
}

absl::Status EpochTrainer::LoadState(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return absl::NotFoundError(file.string() + ": no such file");
  try {
    torch::serialize::InputArchive archive;
    archive.load_from(file.string());
    c10::IValue value;
    if (!archive.try_read("version", value) || value.toInt() != kStateVersion) {
      return absl::FailedPreconditionError(
          absl::StrCat(file.string(), ": expected state version ", kStateVersion,
                       ", got that of another version of the trainer; choose another folder"));
    }
    archive.read("identity", value);
    if (value.toStringRef() != Identity()) {
      return absl::FailedPreconditionError(
          absl::StrCat(file.string(), ": was begun with other options or data: ",
                       FirstDifference(value.toStringRef(), Identity()),
                       "; use the same to resume it, or choose another folder"));
    }
    torch::NoGradGuard no_grad;
    for (auto& [name, tensor] : StateTensors()) {
      torch::Tensor saved;
      archive.read(name, saved);
      tensor.copy_(saved);
    }
    archive.read("epoch", value);
    epoch_ = value.toInt();
    archive.read("best_epoch", value);
    best_epoch_ = value.toInt();
    archive.read("best_afd", value);
    best_afd_ = value.toDouble();
    for (const auto& [name, optimiser] : StateOptimisers()) {
      torch::serialize::InputArchive one;
      archive.read(name, one);
      optimiser->load(one);
    }
  } catch (const std::exception& error) {
    return absl::DataLossError(absl::StrCat(file.string(), ": cannot be read: ", error.what()));
  }
  return absl::OkStatus();
}

}  // namespace duet::training
