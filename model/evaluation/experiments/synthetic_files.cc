#include "model/evaluation/experiments/synthetic_files.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/file.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/formats/flat/json_motion.h"

namespace duet::evaluation::experiments {
namespace {

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

// One person: the folder never contains the captured follower.
absl::Status WriteLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    return absl::InternalError(absl::StrCat(file.parent_path().string(), ": ", error.message()));
  }
  return base::WriteFile(file, formats::flat::FormatJsonMotion(sequence.pair.leader, skeleton));
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
  const absl::StatusOr<nlohmann::json> entry =
      base::ParseStrictJson({line.data(), line.size()}, kIndexDepth);
  if (!entry.ok()) return entry.status();
  const auto text = [&entry](const char* pointer) -> std::string {
    const nlohmann::json::json_pointer at(pointer);
    return entry->contains(at) && (*entry)[at].is_string() ? (*entry)[at].get<std::string>() : "";
  };
  const std::string path = text("/files/0/path"), half = text("/extra/half");
  Asked asked;
  if (path.empty()) return absl::InvalidArgumentError("files: expected one file, got none");
  if (!absl::SimpleAtoi(half, &asked.half)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "extra.half: expected a seed that --write-jobs wrote, got ", base::Quoted(half)));
  }
  if (entry->contains("partner_direction")) {
    asked.partner_direction = ToDirection((*entry)["partner_direction"]);
    if (!asked.partner_direction) {
      return absl::InvalidArgumentError("partner_direction: expected three numbers");
    }
  }
  return std::make_pair(path, asked);
}

// By path.
absl::StatusOr<std::map<std::string, Asked>> ReadIndex(const fs::path& file) {
  absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIndexBytes, "an index");
  if (!text.ok()) return text.status();
  std::map<std::string, Asked> index;
  base::LineReader lines(*text);
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

absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const fs::path& folder) {
  std::string lines = "leader\tlabels\tpartner_direction\thalf\n";
  for (const SyntheticJob& job : jobs) {
    const std::string leader = LeaderPath(job.sequence);
    absl::StrAppend(&lines, leader, "\t", LabelText(dataset, job.labels), "\t",
                    PartnerText(job.sequence.partner_direction), "\t", half, "\n");
    absl::Status status = WriteLeader(dataset.skeleton, job.sequence, folder / leader);
    if (!status.ok()) return status;
  }
  return base::WriteFile(folder / "manifest.tsv", lines);
}

absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const fs::path& folder) {
  absl::StatusOr<dataset::Dataset> read = dataset::ReadDataset(folder);
  if (!read.ok()) return read.status();
  absl::Status status = CheckSame(dataset, *read, folder);
  if (!status.ok()) return status;
  const fs::path index_file = folder / "index.jsonl";
  absl::StatusOr<std::map<std::string, Asked>> index = ReadIndex(index_file);
  if (!index.ok()) return index.status();
  if (index->size() != read->sequences.size()) {
    return absl::InvalidArgumentError(absl::StrCat(index_file.string(), ": expected the ",
                                                   read->sequences.size(),
                                                   " clips of the folder, got ", index->size()));
  }
  SyntheticSet set;
  set.sequences = std::move(read->sequences);
  for (dataset::Sequence& sequence : set.sequences) {
    const auto asked = index->find(sequence.id);
    if (asked == index->end()) {
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
