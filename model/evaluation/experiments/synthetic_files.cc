#include "model/evaluation/experiments/synthetic_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/formats/flat/json_motion.h"
#include "model/motion/motion_limits.h"

namespace duet::evaluation::experiments {
namespace {

namespace fs = std::filesystem;

constexpr char kHeader[] = "id\tclass\thalf\tlabels\tpartner";
constexpr size_t kColumns = 5;
constexpr size_t kMaxJobsBytes = size_t{16} << 20;

std::string LabelText(const dataset::Dataset& dataset, const std::vector<float>& labels) {
  std::vector<std::string> words;
  for (size_t c = 0; c < labels.size(); ++c) {
    if (labels[c] != 0) words.push_back(absl::StrCat(dataset.classes[c], "=", labels[c]));
  }
  return absl::StrJoin(words, ";");
}

std::string PartnerText(const std::optional<motion::Vec3>& direction) {
  if (!direction) return "-";
  const motion::Vec3 plain = *direction + motion::Vec3{};  // no minus before a zero
  return absl::StrCat(plain.x, ",", plain.y, ",", plain.z);
}

// One person, as docs/formats.md has it: the answer is nowhere in the folder before it is given.
std::string LeaderJson(const motion::Clip& leader) {
  nlohmann::json frames = nlohmann::json::array();
  for (int t = 0; t < leader.frame_count(); ++t) {
    nlohmann::json joints = nlohmann::json::array();
    for (int j = 0; j < leader.joint_count(); ++j) {
      const motion::Vec3& point = leader.at(t, j);
      joints.push_back({point.x, point.y, point.z});
    }
    frames.push_back(std::move(joints));
  }
  return nlohmann::json{
      {"format", "duet-motion"},    {"version", 1},      {"frame_rate_hz", leader.frame_rate_hz},
      {"unit", "metres"},           {"up_axis", "y-up"}, {"joint_names", leader.joint_names},
      {"leader", std::move(frames)}}
      .dump();
}

// An id that names a file in its folder and nothing else.
bool IsFileName(absl::string_view id) {
  return !id.empty() && id.front() != '.' && std::all_of(id.begin(), id.end(), [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  });
}

// A line of jobs.tsv, or why it is none.
class JobLine {
 public:
  JobLine(const dataset::Dataset& dataset, const std::string& source, int number,
          absl::string_view text)
      : dataset_(dataset), source_(source), number_(number), fields_(absl::StrSplit(text, '\t')) {}

  absl::Status Read(uint64_t* half, dataset::Sequence* sequence) const {
    if (fields_.size() != kColumns) {
      return Error(absl::StrCat(fields_.size(), " columns came, wanted ", kColumns));
    }
    if (!IsFileName(fields_[0])) {
      return Error(
          absl::StrCat("id: ", base::Quoted(fields_[0]), " came, wanted letters, digits, _-."));
    }
    sequence->id = fields_[0];
    const auto found = std::find(dataset_.classes.begin(), dataset_.classes.end(), fields_[1]);
    if (found == dataset_.classes.end()) {
      return Error(absl::StrCat("class: ", base::Quoted(fields_[1]), " came, wanted one of ",
                                absl::StrJoin(dataset_.classes, ", ")));
    }
    sequence->interaction_class = static_cast<int>(found - dataset_.classes.begin());
    if (!absl::SimpleAtoi(fields_[2], half)) {
      return Error(absl::StrCat("half: ", base::Quoted(fields_[2]), " came, wanted a seed"));
    }
    return ReadPartner(sequence);
  }

 private:
  absl::Status ReadPartner(dataset::Sequence* sequence) const {
    if (fields_[4] == "-") return absl::OkStatus();
    const std::vector<absl::string_view> values = absl::StrSplit(fields_[4], ',');
    motion::Vec3 direction;
    if (values.size() != 3 || !motion::ParseCoordinate(values[0], &direction.x) ||
        !motion::ParseCoordinate(values[1], &direction.y) ||
        !motion::ParseCoordinate(values[2], &direction.z) ||
        (direction.x == 0 && direction.z == 0)) {
      return Error(absl::StrCat("partner: ", base::Quoted(fields_[4]),
                                " came, wanted - or x,y,z of a horizontal direction"));
    }
    sequence->partner_direction = direction;
    return absl::OkStatus();
  }

  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, number_, message);
  }

  const dataset::Dataset& dataset_;
  const std::string& source_;
  int number_;
  std::vector<std::string> fields_;
};

absl::Status WrongAnswer(const fs::path& file, absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat(file.string(), ": ", message));
}

// An answer as the client writes it. Stricter than ReadLeader, which takes the only person of a
// file for either.
absl::Status ReadPair(const dataset::Dataset& dataset, const fs::path& file,
                      motion::ClipPair* pair) {
  absl::StatusOr<std::string> text = base::ReadFile(file, motion::kMaxMotionFileBytes, "a motion");
  if (!text.ok()) return text.status();
  absl::StatusOr<motion::RecordedMotion> motion =
      formats::flat::ParseJsonMotion(*text, file.string());
  if (!motion.ok()) return motion.status();
  if (motion->people.size() != 2) return WrongAnswer(file, "1 person came, wanted 2");
  if (motion->people[0].joint_names != dataset.skeleton.joint_names) {
    return WrongAnswer(file, "joint_names: wanted those of the data, in their order");
  }
  if (motion->people[0].frame_rate_hz != dataset.frame_rate_hz) {
    return WrongAnswer(file, absl::StrCat("frame_rate_hz: ", motion->people[0].frame_rate_hz,
                                          " came, wanted the data's ", dataset.frame_rate_hz));
  }
  for (motion::Clip& clip : motion->people) {
    for (motion::Vec3& point : clip.poses.all()) point = ToWorld(motion->coordinates, point);
  }
  *pair = {std::move(motion->people[0]), std::move(motion->people[1])};
  return CheckPair(*pair);
}

absl::StatusOr<SyntheticSet> ParseJobs(const dataset::Dataset& dataset, const std::string& source,
                                       absl::string_view text) {
  SyntheticSet set;
  base::LineReader lines(text);
  absl::string_view line;
  if (!lines.Next(&line) || line != kHeader) {
    return base::ErrorAt(
        source, 1,
        absl::StrCat(base::Quoted(line), " came, wanted the header ", base::Quoted(kHeader)));
  }
  while (lines.Next(&line)) {
    dataset::Sequence sequence;
    uint64_t half = 0;
    absl::Status status = JobLine(dataset, source, lines.number(), line).Read(&half, &sequence);
    if (!status.ok()) return status;
    if (!set.sequences.empty() && half != set.half) {
      return base::ErrorAt(source, lines.number(),
                           absl::StrCat("half: ", half, " came, wanted ", set.half, " as above"));
    }
    set.half = half;
    set.sequences.push_back(std::move(sequence));
  }
  if (!set.sequences.empty()) return set;
  return base::ErrorAt(source, 1, "no job came, wanted one or more");
}

}  // namespace

absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const fs::path& folder) {
  for (const char* const name : {"leaders", "followers"}) {
    std::error_code error;
    fs::create_directories(folder / name, error);
    if (error) {
      return absl::InternalError(absl::StrCat((folder / name).string(), ": ", error.message()));
    }
  }
  std::string lines = absl::StrCat(kHeader, "\n");
  for (const SyntheticJob& job : jobs) {
    const dataset::Sequence& sequence = job.sequence;
    absl::StrAppend(&lines, sequence.id, "\t",
                    dataset.classes[static_cast<size_t>(sequence.interaction_class)], "\t", half,
                    "\t", LabelText(dataset, job.labels), "\t",
                    PartnerText(sequence.partner_direction), "\n");
    absl::Status status = base::WriteFile(folder / "leaders" / absl::StrCat(sequence.id, ".json"),
                                          LeaderJson(sequence.pair.leader));
    if (!status.ok()) return status;
  }
  return base::WriteFile(folder / "jobs.tsv", lines);
}

absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const fs::path& folder) {
  const fs::path file = folder / "jobs.tsv";
  absl::StatusOr<std::string> text = base::ReadFile(file, kMaxJobsBytes, "jobs.tsv");
  if (!text.ok()) return text.status();
  absl::StatusOr<SyntheticSet> set = ParseJobs(dataset, file.string(), *text);
  if (!set.ok()) return set;
  for (dataset::Sequence& sequence : set->sequences) {
    absl::Status status = ReadPair(
        dataset, folder / "followers" / absl::StrCat(sequence.id, ".json"), &sequence.pair);
    if (!status.ok()) return status;
  }
  return set;
}

}  // namespace duet::evaluation::experiments
