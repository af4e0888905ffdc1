#include "model/training/run.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/engine/leader_statistics.h"
#include "model/network/exceptions.h"
#include "model/training/augment.h"
#include "model/training/finishing.h"
#include "model/training/flow_trainer.h"
#include "model/training/paper_trainer.h"

namespace duet::training {

extern const char kGitRevision[];  // that this program was configured from; CMake writes it

namespace {

namespace fs = std::filesystem;

constexpr size_t kMostPeopleBytes = 4096;  // of a manifest's text

// Requires a manifest of the same architecture. `validation` may be empty. Options, manifest and
// data set must outlive the trainer.
std::unique_ptr<EpochTrainer> MakeTrainer(const TrainingOptions& options,
                                          const checkpoint::Manifest& manifest,
                                          const dataset::Dataset& dataset, std::vector<int> train,
                                          std::vector<int> validation) {
  if (FlowIn(options) == nullptr) {
    return std::make_unique<PaperTrainer>(options, manifest, dataset, std::move(train),
                                          std::move(validation));
  }
  return std::make_unique<FlowTrainer>(options, manifest, dataset, std::move(train),
                                       std::move(validation));
}

// Records properties of the training sequences for the model card.
void NoteData(const dataset::Dataset& dataset, const std::vector<int>& train,
              std::map<std::string, std::string>* notes) {
  std::set<std::string> people;
  double seconds = 0;
  bool levelled = false;
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    people.insert(sequence.subjects.begin(), sequence.subjects.end());
    seconds += sequence.pair.leader.frame_count() / dataset.frame_rate_hz;
    levelled = levelled || sequence.levelling.up().y < 1 || sequence.levelling.floor_height() != 0;
  }
  (*notes)["seconds"] = absl::StrCat(std::lround(seconds));
  (*notes)["people"] = absl::StrJoin(people, " ").substr(0, kMostPeopleBytes);
  (*notes)["levelled"] = levelled ? "true" : "false";
}

checkpoint::Manifest MakeManifest(const RunPlan& plan, const dataset::Dataset& dataset) {
  checkpoint::Manifest manifest;
  manifest.model.name = plan.model_name;
  manifest.model.version = plan.model_version;
  manifest.model.description = plan.description;
  manifest.model.skeleton = dataset.skeleton;
  manifest.model.classes = dataset.classes;
  manifest.model.touching_classes = dataset.TouchingClasses();
  manifest.model.frame_rate_hz = dataset.frame_rate_hz;
  SetArchitecture(plan.options.architecture, &manifest);
  manifest.parts = dataset.parts;
  manifest.standardisation = plan.options.standardisation;
  manifest.training = Describe(plan.options);
  manifest.training["data"] = dataset.name;
  manifest.training["sequences"] = absl::StrCat(plan.train.size());
  NoteData(dataset, plan.train, &manifest.training);
  return manifest;
}

// What the description of a model says of its training data: `takes` of the whole data set, and the
// windows `train` that they are cut into.
void Measure(const dataset::Dataset& whole, const std::vector<int>& takes,
             const dataset::Dataset& dataset, const std::vector<int>& train,
             const TrainingOptions& options, engine::ModelDescription* model) {
  std::vector<const motion::Poses*> leaders;
  for (const int index : train) {
    leaders.push_back(&dataset.sequences[static_cast<size_t>(index)].pair.leader.poses);
  }
  model->leader_statistics =
      engine::FitLeaderStatistics(dataset.skeleton, leaders, dataset.frame_rate_hz);
  MeasurePairs(whole, takes, dataset, train, model);
  if (FlowIn(options) != nullptr) model->partner_direction = FitPartnerDirection(dataset, train);
}

// Moves the validation sequences from `train` to the result.
std::vector<int> HoldBack(const TrainingOptions& options, const dataset::Dataset& dataset,
                          std::vector<int>* train) {
  std::vector<int> held, kept;
  for (const int index : *train) {
    const std::vector<std::string>& people = dataset.sequences[static_cast<size_t>(index)].subjects;
    const bool is_held =
        std::any_of(options.common.validation().subjects().begin(),
                    options.common.validation().subjects().end(), [&](const std::string& subject) {
                      return std::find(people.begin(), people.end(), subject) != people.end();
                    });
    (is_held ? held : kept).push_back(index);
  }
  *train = kept;
  if (options.common.validation().fraction() > 0) {
    const std::vector<int> more = TakeValidation(dataset, options.common.validation().fraction(),
                                                 options.common.seed(), train);
    held.insert(held.end(), more.begin(), more.end());
  }
  return held;
}

// Appends the windows of the sequences `indices` to `cut` and replaces the indices by theirs.
void CutAll(const dataset::Dataset& whole, int frames, int stride, std::vector<int>* indices,
            dataset::Dataset* cut) {
  std::vector<int> windows;
  for (const int index : *indices) {
    for (dataset::Sequence& window :
         CutIntoWindows(whole.sequences[static_cast<size_t>(index)], frames, stride)) {
      windows.push_back(static_cast<int>(cut->sequences.size()));
      cut->sequences.push_back(std::move(window));
    }
  }
  *indices = std::move(windows);
}

// The data set as the method trains on it. The sequences are held back before they are cut, so that
// no window of a sequence for validation is trained on.
dataset::Dataset CutIfAsked(const TrainingOptions& options, const dataset::Dataset& whole,
                            std::vector<int>* train, std::vector<int>* validation) {
  const FlowSettings* flow = FlowIn(options);
  if (flow == nullptr || flow->flow().window_seconds() == 0) return whole;
  const auto frames = [&](double seconds) {
    return std::max(2, static_cast<int>(std::lround(seconds * whole.frame_rate_hz)));
  };
  dataset::Dataset cut = whole;
  cut.sequences.clear();
  for (std::vector<int>* indices : {train, validation}) {
    CutAll(whole, frames(flow->flow().window_seconds()), frames(flow->flow().stride_seconds()),
           indices, &cut);
  }
  return cut;
}

// The checkpoint that the run begins with, noted in the manifest; an empty one if there is none.
absl::StatusOr<checkpoint::Checkpoint> ReadFrom(const RunPlan& plan,
                                                checkpoint::Manifest* manifest) {
  if (plan.from.empty()) return checkpoint::Checkpoint();
  DUET_TRY(checkpoint::Checkpoint from, checkpoint::ReadCheckpoint(plan.from));
  const engine::ModelDescription& model = from.manifest.model;
  if (model.skeleton.joint_names != manifest->model.skeleton.joint_names ||
      model.classes != manifest->model.classes) {
    return absl::InvalidArgumentError(absl::StrCat(
        plan.from.string(), ": expected the joints and classes of the data (",
        absl::StrJoin(manifest->model.skeleton.joint_names, " "), "; ",
        absl::StrJoin(manifest->model.classes, " "), "), got ",
        absl::StrJoin(model.skeleton.joint_names, " "), "; ", absl::StrJoin(model.classes, " ")));
  }
  manifest->training["from"] =
      absl::StrCat(model.name, "@", model.version, " ", from.manifest.weights.sha256);
  return from;
}

absl::Status StartFrom(const RunPlan& plan, const checkpoint::Checkpoint& from,
                       EpochTrainer* trainer) {
  if (plan.from.empty()) return absl::OkStatus();
  const absl::Status started = trainer->StartFrom(from);
  if (started.ok()) return started;
  return absl::InvalidArgumentError(
      absl::StrCat(plan.from.string(),
                   ": expected the architecture of the options, got another: ", started.message()));
}

// Adds what is learnt from the answers of a finished generator, if the settings ask for it: a
// critic, and the seeds whose followers move as captured ones do.
absl::Status AddCritic(const RunPlan& plan, const dataset::Dataset& dataset,
                       const std::vector<int>& train, std::ostream* progress,
                       checkpoint::Checkpoint* checkpoint) {
  const FlowSettings* flow = FlowIn(plan.options);
  if (flow == nullptr || flow->critic().steps() == 0) return absl::OkStatus();
  DUET_TRY(TrainedCritic critic,
           TrainCritic(*flow, plan.options.common.seed(), *checkpoint, dataset, train));
  DUET_TRY(const auto synthesizer, SynthesizerOf(*checkpoint));
  DUET_TRY(checkpoint->manifest.model.default_seeds,
           ChooseDefaultSeeds(*synthesizer, dataset, train));
  checkpoint->critic = std::move(critic.tensors);
  checkpoint->manifest.metrics["training.critic"] = critic.loss;
  *progress << plan.title << ": critic: "
            << absl::StrFormat("loss %.2f (0.69: cannot tell answers from captured followers)\n",
                               critic.loss);
  return absl::OkStatus();
}

absl::Status Write(const RunPlan& plan, checkpoint::Checkpoint checkpoint) {
  std::error_code error;
  fs::create_directories(CheckpointFolder(plan).parent_path(), error);
  return checkpoint::WriteCheckpoint(CheckpointFolder(plan), std::move(checkpoint));
}

absl::Status Finish(const RunPlan& plan, const dataset::Dataset& dataset,
                    const std::vector<int>& train, checkpoint::Manifest manifest,
                    const EpochReport& last, EpochTrainer* trainer, std::ostream* progress) {
  manifest.git_revision = kGitRevision;
  // A run that was killed after its last epoch has no report of it any more.
  if (last.epoch > 0) manifest.metrics["training.reconstruction"] = last.reconstruction;
  if (std::isfinite(trainer->best_afd())) {
    manifest.metrics["validation.afd"] = trainer->best_afd();
    manifest.metrics["validation.epoch"] = static_cast<double>(trainer->best_epoch());
  }
  checkpoint::Checkpoint checkpoint{std::move(manifest), trainer->BestTensors(), {}};
  DUET_RETURN_IF_ERROR(AddCritic(plan, dataset, train, progress, &checkpoint));
  return Write(plan, std::move(checkpoint));
}

constexpr char kColumns[] =
    "epoch,generator,reconstruction,bone,continuity,adversarial,discriminator,validation_afd,"
    "validation_afd_pose,seconds,whole_answers";
constexpr int kBarWidth = 24;

std::string Optional(double value) {
  return std::isnan(value) ? "" : absl::StrFormat("%.6f", value);
}

std::string Row(const EpochReport& r) {
  return absl::StrFormat("%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%s,%s,%.3f,%d", r.epoch, r.generator,
                         r.reconstruction, r.bone, r.continuity, r.adversarial, r.discriminator,
                         Optional(r.validation_afd), Optional(r.validation_afd_pose), r.seconds,
                         r.whole_answers ? 1 : 0);
}

absl::Status WriteText(const fs::path& file, const std::string& text, std::ios::openmode mode) {
  std::ofstream out(file, mode);
  out << text;
  out.flush();
  if (out) return absl::OkStatus();
  return absl::InternalError(absl::StrCat(file.string(), ": cannot be written"));
}

// Prepares the log for epochs after `epoch`: a file with the names of the columns, without the rows
// of later epochs, which a run wrote before it was killed without saving its state.
absl::Status ResumeLog(const fs::path& file, int64_t epoch) {
  std::string kept = absl::StrCat(kColumns, "\n");
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // the column names
  while (std::getline(in, line)) {
    const int64_t row_epoch = std::strtoll(line.c_str(), nullptr, 10);
    if (row_epoch >= 1 && row_epoch <= epoch) absl::StrAppend(&kept, line, "\n");
  }
  return WriteText(file, kept, std::ios::trunc);
}

// "[#####.....] epoch 12/60  loss 3.214  val 0.61  0:14 left"; on a terminal, over the line before.
void Show(const RunPlan& plan, const EpochReport& report, bool terminal, std::ostream* progress) {
  const auto filled = static_cast<size_t>(kBarWidth * report.epoch / report.epochs);
  const int64_t left =
      std::llround(static_cast<double>(report.epochs - report.epoch) * report.seconds);
  const std::string validation =
      std::isnan(report.validation_afd) ? "" : absl::StrFormat("  val %.4f", report.validation_afd);
  *progress << (terminal ? "\r" : "")
            << absl::StrFormat("%s [%s%s] epoch %d/%d  loss %.4f%s  %d:%02d left", plan.title,
                               std::string(filled, '#'), std::string(kBarWidth - filled, '.'),
                               report.epoch, report.epochs, report.generator, validation, left / 60,
                               left % 60)
            << (terminal && report.epoch < report.epochs ? "\033[K" : "\n") << std::flush;
}

}  // namespace

absl::Status SetTrainingThreads(int threads) {
  // Every step frees memory that the next allocates again. Keeping it avoids returning pages to the
  // system and faulting them in again.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  return network::SetThreads(threads);
}

fs::path CheckpointFolder(const RunPlan& plan) {
  return plan.folder / "checkpoint" / plan.model_name / absl::StrCat(plan.model_version);
}

absl::Status RunTraining(const RunPlan& plan, const dataset::Dataset& whole, bool terminal,
                         std::ostream* progress) {
  DUET_RETURN_IF_ERROR(CheckAgainst(plan.options, whole));
  DUET_RETURN_IF_ERROR(CheckStillness(plan.options, whole));
  if (fs::exists(CheckpointFolder(plan))) {
    *progress << plan.title << " is finished: " << CheckpointFolder(plan).string() << "\n";
    return absl::OkStatus();
  }
  std::vector<int> train = plan.train;
  std::vector<int> validation = HoldBack(plan.options, whole, &train);
  const std::vector<int> takes = train;
  const dataset::Dataset dataset = CutIfAsked(plan.options, whole, &train, &validation);
  checkpoint::Manifest manifest = MakeManifest(plan, whole);
  manifest.model.window_frames = dataset.LongestFrameCount();
  if (const FlowSettings* flow = FlowIn(plan.options)) {
    manifest.model.lookahead_frames =
        static_cast<int>(std::lround(flow->flow().lookahead_seconds() * whole.frame_rate_hz));
  }
  DUET_RETURN_IF_ERROR(checkpoint::CheckManifest(manifest));
  std::error_code error;
  fs::create_directories(plan.folder, error);
  if (error) return absl::InternalError(absl::StrCat(plan.folder.string(), ": ", error.message()));
  if (train.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        plan.title,
        ": expected sequences to train on, got none: validation holds back every sequence"));
  }
  Measure(whole, takes, dataset, train, plan.options, &manifest.model);
  DUET_TRY(checkpoint::Checkpoint from, ReadFrom(plan, &manifest));
  const std::unique_ptr<EpochTrainer> trainer =
      MakeTrainer(plan.options, manifest, dataset, train, validation);
  DUET_RETURN_IF_ERROR(trainer->UseDevice(plan.device));
  const fs::path state = plan.folder / "state";
  absl::Status status = trainer->LoadState(state);
  if (absl::IsNotFound(status)) status = StartFrom(plan, from, trainer.get());
  DUET_RETURN_IF_ERROR(status);
  const fs::path log = plan.folder / "log.csv";
  DUET_RETURN_IF_ERROR(ResumeLog(log, trainer->epoch()));
  *progress << plan.title << ": " << train.size() << " sequences, "
            << plan.options.common.epochs() * trainer->steps_per_epoch() << " steps\n";
  EpochReport report;
  while (!trainer->Finished()) {
    const bool first = report.epoch == 0, scored = report.whole_answers;
    report = trainer->RunEpoch();
    if (!std::isfinite(report.generator)) {
      return absl::InternalError(
          absl::StrCat(plan.title, ": the loss is no longer finite at epoch ", report.epoch,
                       "; lower optimiser.learning_rate or set optimiser.gradient_clip"));
    }
    // The log before the state: resuming drops a row without its state, but cannot restore a lost
    // row.
    DUET_RETURN_IF_ERROR(WriteText(log, Row(report) + "\n", std::ios::app));
    DUET_RETURN_IF_ERROR(trainer->SaveState(state));
    if (report.whole_answers && !scored && !first) {
      *progress << (terminal ? "\n" : "") << plan.title << ": from epoch " << report.epoch
                << " the loss is the score of whole answers (energy.from), on another scale than "
                   "before\n";
    }
    Show(plan, report, terminal, progress);
  }
  if (std::isfinite(trainer->best_afd())) {
    *progress << plan.title << ": epoch " << trainer->best_epoch() << " of " << trainer->epoch()
              << " is kept: least error on what was held back, "
              << absl::StrFormat("%.4f m", trainer->best_afd()) << "\n";
  }
  return Finish(plan, dataset, train, manifest, report, trainer.get(), progress);
}

}  // namespace duet::training
