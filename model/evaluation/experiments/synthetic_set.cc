#include "model/evaluation/experiments/synthetic_set.h"

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/file.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/evaluation/experiments/answers.h"
#include "model/formats/flat/json_motion.h"
#include "model/training/augment.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kLeastOwn = 0.75, kMostOwn = 1.25, kMostOwnMixed = 1;
constexpr double kLeastOther = 0.1, kMostOther = 0.35;

training::TrainingOptions::Augmentation Variations() {
  training::TrainingOptions::Augmentation augmentation;
  augmentation.swap_roles = 0.5;
  augmentation.body_scale = 0.08;
  augmentation.time_warp = 0.1;
  augmentation.leader_yaw = 0.1;
  return augmentation;
}

std::vector<float> DrawLabels(int classes, int own, bool mix, base::Random* random) {
  std::vector<float> labels(static_cast<size_t>(classes), 0);
  const double weight = random->Uniform(kLeastOwn, mix ? kMostOwnMixed : kMostOwn);
  labels[static_cast<size_t>(own)] = static_cast<float>(weight);
  if (!mix) return labels;
  int other = static_cast<int>(random->Below(classes - 1));
  if (other >= own) ++other;
  labels[static_cast<size_t>(other)] = static_cast<float>(random->Uniform(kLeastOther, kMostOther));
  return labels;
}

// A class's name as part of a file's.
std::string FileName(std::string name) {
  for (char& c : name) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

namespace fs = std::filesystem;

constexpr size_t kMaxIndexBytes = size_t{256} << 20;
constexpr int kIndexDepth = 8;

std::string LabelText(const dataset::Dataset& dataset, const std::vector<float>& labels) {
  std::vector<std::string> words;
  for (size_t c = 0; c < labels.size(); ++c) {
    if (labels[c] != 0) words.push_back(absl::StrCat(dataset.classes[c], "=", labels[c]));
  }
  return absl::StrJoin(words, ",");
}

std::string PartnerText(const std::optional<motion::Vec3>& direction) {
  if (!direction) return "";
  const motion::Vec3 plain = *direction + motion::Vec3{};  // no minus before a zero
  return absl::StrCat(plain.x, ",", plain.y, ",", plain.z);
}

// The path of a job's leader below the folder; its first part is the captured set.
std::string LeaderPath(const dataset::Sequence& sequence) {
  return absl::StrCat("leaders/", sequence.set, sequence.set.empty() ? "" : "/", sequence.id,
                      ".json");
}

// The index's fields of a clip.
struct Asked {
  uint64_t half = 0;
  std::optional<motion::Vec3> partner_direction;
};

std::optional<motion::Vec3> ToDirection(const nlohmann::json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  for (const nlohmann::json& coordinate : value) {
    if (!coordinate.is_number()) return std::nullopt;
  }
  return motion::Vec3{value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

// A line of index.jsonl.
absl::StatusOr<std::pair<std::string, Asked>> ParseEntry(absl::string_view line) {
  DUET_TRY(const auto entry, base::ParseStrictJson({line.data(), line.size()}, kIndexDepth));
  const auto text = [&entry](const char* pointer) -> std::string {
    const nlohmann::json::json_pointer at(pointer);
    return entry.contains(at) && entry[at].is_string() ? entry[at].get<std::string>() : "";
  };
  const std::string path = text("/files/0/path"), half = text("/extra/half");
  Asked asked;
  if (path.empty()) return absl::InvalidArgumentError("files: expected one file, got none");
  if (!absl::SimpleAtoi(half, &asked.half)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "extra.half: expected a seed that --write-jobs wrote, got ", base::Quoted(half)));
  }
  if (entry.contains("partner_direction")) {
    asked.partner_direction = ToDirection(entry["partner_direction"]);
    if (!asked.partner_direction) {
      return absl::InvalidArgumentError("partner_direction: expected three numbers");
    }
  }
  return std::make_pair(path, asked);
}

// By path.
absl::StatusOr<std::map<std::string, Asked>> ReadIndex(const fs::path& file) {
  DUET_TRY(std::string text, base::ReadFile(file, kMaxIndexBytes, "an index"));
  std::map<std::string, Asked> index;
  base::LineReader lines(text);
  for (absl::string_view line; lines.Next(&line);) {
    absl::StatusOr<std::pair<std::string, Asked>> entry = ParseEntry(line);
    if (!entry.ok()) {
      return base::ErrorAt(file.string(), lines.number(), entry.status().message());
    }
    if (!index.empty() && entry->second.half != index.begin()->second.half) {
      return base::ErrorAt(file.string(), lines.number(),
                           absl::StrCat("half: expected ", index.begin()->second.half,
                                        " as above, got ", entry->second.half));
    }
    index.insert(*std::move(entry));
  }
  return index;
}

absl::Status CheckSame(const dataset::Dataset& wanted, const dataset::Dataset& came,
                       const fs::path& folder) {
  const auto refuse = [&folder](absl::string_view what) {
    return absl::InvalidArgumentError(
        absl::StrCat(folder.string(), ": expected the ", what, " of the data"));
  };
  if (came.skeleton.joint_names != wanted.skeleton.joint_names) return refuse("joints");
  if (came.classes != wanted.classes) return refuse("classes");
  if (came.frame_rate_hz != wanted.frame_rate_hz) return refuse("frame rate");
  return absl::OkStatus();
}

// Restores the level world of request and answer, whatever the reader did.
void UndoLevelling(dataset::Sequence* sequence) {
  for (motion::Clip* clip : {&sequence->pair.leader, &sequence->pair.follower}) {
    clip->poses = sequence->levelling.Invert(std::move(clip->poses));
  }
  sequence->levelling = {};
}

}  // namespace

std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options) {
  base::Random random(options.seed, 0);
  std::vector<SyntheticJob> jobs;
  for (int c = 0; c < dataset.class_count(); ++c) {
    std::vector<int> leaders;
    for (const int index : train) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      if (sequence.interaction_class == c) leaders.push_back(index);
    }
    random.Shuffle(&leaders);
    for (int i = 0; i < options.match + options.mix; ++i) {
      const int leader = leaders[static_cast<size_t>(i) % leaders.size()];
      SyntheticJob job;
      job.sequence =
          Augment(dataset, dataset.sequences[static_cast<size_t>(leader)], Variations(), &random);
      job.sequence.pair.follower.poses = {};
      job.sequence.id = absl::StrFormat(
          "%s-%03d", FileName(dataset.classes[static_cast<size_t>(c)]), jobs.size() + 1);
      job.labels = DrawLabels(dataset.class_count(), c, i >= options.match, &random);
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs) {
  DUET_RETURN_IF_ERROR(CheckModelFits(synthesizer.description(), dataset));
  std::vector<dataset::Sequence> answered;
  for (const SyntheticJob& job : jobs) {
    absl::StatusOr<motion::Poses> follower =
        SynthesizeSequence(synthesizer, job.sequence, job.labels, StartGiven::kNone);
    if (!follower.ok()) {
      return absl::Status(follower.status().code(),
                          absl::StrCat(job.sequence.id, ": ", follower.status().message()));
    }
    answered.push_back(job.sequence);
    answered.back().pair.follower.poses = *std::move(follower);
  }
  return answered;
}

absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const fs::path& folder) {
  std::string lines = "leader\tlabels\tpartner_direction\thalf\n";
  for (const SyntheticJob& job : jobs) {
    const std::string leader = LeaderPath(job.sequence);
    absl::StrAppend(&lines, leader, "\t", LabelText(dataset, job.labels), "\t",
                    PartnerText(job.sequence.partner_direction), "\t", half, "\n");
    std::error_code error;  // base::WriteFile reports a folder that cannot be made
    fs::create_directories((folder / leader).parent_path(), error);
    // One person: the folder never contains the captured follower.
    DUET_RETURN_IF_ERROR(base::WriteFile(
        folder / leader,
        formats::flat::FormatJsonMotion({job.sequence.pair.leader}, dataset.skeleton)));
  }
  return base::WriteFile(folder / "manifest.tsv", lines);
}

absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const fs::path& folder) {
  DUET_TRY(dataset::Dataset read, dataset::ReadDataset(folder));
  DUET_RETURN_IF_ERROR(CheckSame(dataset, read, folder));
  const fs::path index_file = folder / "index.jsonl";
  DUET_TRY(auto index, ReadIndex(index_file));
  if (index.size() != read.sequences.size()) {
    return absl::InvalidArgumentError(absl::StrCat(index_file.string(), ": expected the ",
                                                   read.sequences.size(),
                                                   " clips of the folder, got ", index.size()));
  }
  SyntheticSet set;
  set.sequences = std::move(read.sequences);
  for (dataset::Sequence& sequence : set.sequences) {
    const auto asked = index.find(sequence.id);
    if (asked == index.end()) {
      return absl::InvalidArgumentError(absl::StrCat(index_file.string(), ": expected an entry of ",
                                                     base::Quoted(sequence.id), ", got none"));
    }
    set.half = asked->second.half;
    sequence.partner_direction = asked->second.partner_direction;
    UndoLevelling(&sequence);
  }
  return set;
}

}  // namespace duet::evaluation::experiments
