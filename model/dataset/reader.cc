// ReadDataset: recognises the layout, lists the files and reads each.
#include <algorithm>
#include <map>
#include <optional>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/dataset/dataset.h"
#include "model/dataset/layout.h"
#include "model/dataset/leader_side.h"
#include "model/formats/flat/flat_files.h"

namespace duet::dataset {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxIndexBytes = size_t{16} << 20;
constexpr char kTimeLines[] = "labels.tsv";
constexpr size_t kMaxLayoutBytes = size_t{1} << 20;

// A file of the data set, found but not read.
struct FoundFile {
  std::string id;  // path below the folder, with '/'
  std::string set;
  int interaction_class = 0;
  std::vector<std::string> subjects;
  std::vector<LabelSpan> labels;
};

// The names in a folder, sorted; hidden ones are not part of a data set.
absl::StatusOr<std::vector<std::string>> ListFolder(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name[0] != '.') names.push_back(name);
  }
  if (error) return absl::NotFoundError(absl::StrCat(folder.string(), ": ", error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// An error in a file of the folder, which the message names.
absl::Status Below(const fs::path& folder, const absl::Status& status) {
  return absl::InvalidArgumentError(absl::StrCat((folder / "").string(), status.message()));
}

// <set>/<class>/<sequence>/skeleton_pos.txt in each set of `names`. Ignores other classes
// (approaching, departing).
absl::StatusOr<std::vector<FoundFile>> FindSbuFiles(const fs::path& folder,
                                                    const DatasetLayout& layout,
                                                    const std::vector<std::string>& names) {
  std::vector<FoundFile> found;
  for (const std::string& set : names) {
    if (!IsSbuSet(set) || !IsFolder(folder / set)) continue;
    for (size_t i = 0; i < layout.classes.size(); ++i) {
      const std::string in_set = absl::StrCat(set, "/", layout.classes[i].folder);
      if (!IsFolder(folder / in_set)) continue;
      DUET_TRY(const std::vector<std::string> sequences, ListFolder(folder / in_set));
      for (const std::string& sequence : sequences) {
        if (!IsFolder(folder / in_set / sequence)) continue;
        found.push_back({absl::StrCat(in_set, "/", sequence, "/skeleton_pos.txt"),
                         set,
                         static_cast<int>(i),
                         {set.substr(0, 3), set.substr(3, 3)},
                         {}});
      }
    }
  }
  return found;
}

// <class>/<sequence>.txt for every class of the layout that has a folder.
absl::StatusOr<std::vector<FoundFile>> FindClassFiles(const fs::path& folder,
                                                      const DatasetLayout& layout) {
  std::vector<FoundFile> found;
  for (size_t i = 0; i < layout.classes.size(); ++i) {
    const std::string& one = layout.classes[i].folder;
    if (!IsFolder(folder / one)) continue;
    DUET_TRY(const std::vector<std::string> names, ListFolder(folder / one));
    for (const std::string& name : names) {
      if (fs::path(name).extension() != ".txt") continue;
      found.push_back({absl::StrCat(one, "/", name), "", static_cast<int>(i), {}, {}});
    }
  }
  return found;
}

// The files that labels.tsv names, with their time lines.
absl::StatusOr<std::vector<FoundFile>> FindLabelledFiles(const fs::path& folder,
                                                         const DatasetLayout& layout) {
  DUET_TRY(const std::string text,
           base::ReadFile(folder / kTimeLines, kMaxIndexBytes, "classes on a time line"));
  std::vector<std::string> classes;
  for (const ClassLayout& one : layout.classes) classes.push_back(one.name);
  absl::StatusOr<std::map<std::string, std::vector<LabelSpan>>> time_lines =
      ParseTimeLines(text, classes, layout.frame_rate_hz);
  if (!time_lines.ok()) return Below(folder, time_lines.status());
  std::vector<FoundFile> found;
  for (auto& [path, labels] : *time_lines) {
    found.push_back({path, "", LongestClass(labels), {}, std::move(labels)});
  }
  return found;
}

absl::StatusOr<std::map<std::string, IndexEntry>> ReadIndex(const fs::path& folder) {
  if (!Exists(folder / "index.tsv")) return std::map<std::string, IndexEntry>{};
  DUET_TRY(const std::string text,
           base::ReadFile(folder / "index.tsv", kMaxIndexBytes, "an index of sequences"));
  absl::StatusOr<std::map<std::string, IndexEntry>> index = ParseIndex(text);
  if (!index.ok()) return Below(folder, index.status());
  // With a misspelt path, the motion rule would silently choose the leader of that file.
  for (const auto& [path, entry] : *index) {
    if (Exists(folder / path)) continue;
    return base::ErrorAt((folder / "index.tsv").string(), entry.line,
                         absl::StrCat("path: expected a file below ", folder.string(), ", got ",
                                      base::Quoted(path)));
  }
  return index;
}

absl::StatusOr<formats::flat::SbuRecording> ReadPeople(const std::string& path,
                                                       const DatasetLayout& layout) {
  formats::flat::SbuOptions options;
  options.joint_names = layout.skeleton.joint_names;
  options.frame_rate_hz = layout.frame_rate_hz;
  options.coordinates = layout.coordinates;
  absl::StatusOr<formats::flat::SbuRecording> people = ReadSbu(path, options);
  if (people.ok() && people->left.frame_count() < 2) {
    return base::ErrorAt(path, 1, "frames: expected at least 2, got 1");
  }
  return people;
}

// The end of the axis at which the follower stands, inferred from the pair: the order in the files
// differs from set to set.
std::optional<motion::Vec3> PartnerDirection(const DatasetLayout& layout,
                                             const motion::ClipPair& pair) {
  if (!layout.people_axis) return std::nullopt;
  const int root = layout.skeleton.root;
  const motion::Vec3 across = pair.follower.at(0, root) - pair.leader.at(0, root);
  return Dot(across, *layout.people_axis) < 0 ? -*layout.people_axis : *layout.people_axis;
}

// A time line must end with its sequence.
absl::Status CheckTimeLine(const std::string& path, const DatasetLayout& layout,
                           const Sequence& sequence) {
  const int frames = sequence.pair.leader.frame_count();
  for (const LabelSpan& span : sequence.labels) {
    if (span.end <= frames) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(kTimeLines, ": to_seconds of class ",
                     layout.classes[static_cast<size_t>(span.interaction_class)].name, " of ", path,
                     ": expected at most ", frames / layout.frame_rate_hz,
                     ", the sequence's length, got ", span.end / layout.frame_rate_hz));
  }
  return absl::OkStatus();
}

absl::StatusOr<Sequence> ReadSequence(const fs::path& folder, const DatasetLayout& layout,
                                      const IndexEntry& entry, const FoundFile& file) {
  const std::string path = (folder / file.id).string();
  DUET_TRY(formats::flat::SbuRecording people, ReadPeople(path, layout));
  Sequence sequence;
  sequence.id = file.id;
  sequence.set = file.set;
  sequence.interaction_class = file.interaction_class;
  sequence.subjects = entry.subjects.empty() ? file.subjects : entry.subjects;
  sequence.leader_source = entry.guessed ? "guess" : "index";
  LeaderSide side = entry.leader_side;
  if (side == LeaderSide::kUnknown) {
    const ClassLayout& one = layout.classes[static_cast<size_t>(file.interaction_class)];
    if (one.effectors.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          path, ": leader_side: expected left or right in index.tsv, or effectors for class ",
          one.name, " in dataset.json, got neither"));
    }
    sequence.leader_source = "motion";
    side = LeaderByMotion(people.left, people.right, layout.skeleton.root, one.effectors);
  }
  if (side == LeaderSide::kRight) std::swap(people.left, people.right);
  sequence.pair = {std::move(people.left), std::move(people.right)};
  sequence.partner_direction = PartnerDirection(layout, sequence.pair);
  sequence.labels = file.labels;
  DUET_RETURN_IF_ERROR(CheckTimeLine(path, layout, sequence));
  return sequence;
}

absl::StatusOr<Dataset> ReadFiles(const fs::path& folder, const DatasetLayout& layout,
                                  std::vector<FoundFile> files) {
  if (files.empty()) {
    return absl::NotFoundError(absl::StrCat(folder.string(),
                                            ": expected sequences of the classes of ", layout.name,
                                            ", got none; see docs/datasets.md"));
  }
  std::sort(files.begin(), files.end(),
            [](const FoundFile& a, const FoundFile& b) { return a.id < b.id; });
  DUET_TRY(auto index, ReadIndex(folder));
  Dataset dataset;
  dataset.name = layout.name;
  dataset.skeleton = layout.skeleton;
  dataset.parts = layout.parts;
  dataset.notes = layout.notes;
  dataset.frame_rate_hz = layout.frame_rate_hz;
  for (const ClassLayout& one : layout.classes) {
    dataset.classes.push_back(one.name);
    dataset.symmetric.push_back(one.symmetric);
    dataset.handed.push_back(one.handed);
    dataset.touches.push_back(one.touches);
  }
  for (const FoundFile& file : files) {
    DUET_TRY(dataset.sequences.emplace_back(), ReadSequence(folder, layout, index[file.id], file));
  }
  if (layout.level) LevelSets(&dataset);
  return dataset;
}

absl::StatusOr<Dataset> ReadOwnData(const fs::path& folder, const std::string& text) {
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(text);
  if (!layout.ok()) return Below(folder, layout.status());
  DUET_TRY(std::vector<FoundFile> files, Exists(folder / kTimeLines)
                                             ? FindLabelledFiles(folder, *layout)
                                             : FindClassFiles(folder, *layout));
  return ReadFiles(folder, *layout, std::move(files));
}

}  // namespace

absl::StatusOr<Dataset> ReadDataset(const fs::path& folder) {
  DUET_TRY(const std::vector<std::string> names, ListFolder(folder));
  if (std::count(names.begin(), names.end(), "dataset.json") > 0) {
    DUET_TRY(const std::string text,
             base::ReadFile(folder / "dataset.json", kMaxLayoutBytes, "a data set's layout"));
    if (!DescribesBatch(text)) return ReadOwnData(folder, text);
  }
  if (std::any_of(names.begin(), names.end(), IsSbuSet)) {
    const DatasetLayout layout = SbuLayout();
    DUET_TRY(std::vector<FoundFile> files, FindSbuFiles(folder, layout, names));
    return ReadFiles(folder, layout, std::move(files));
  }
  const DatasetLayout layout = K3hiLayout();
  DUET_TRY(std::vector<FoundFile> files, FindClassFiles(folder, layout));
  if (!files.empty()) return ReadFiles(folder, layout, std::move(files));
  return absl::NotFoundError(absl::StrCat(
      folder.string(), ": expected sXXsYY/<class>/<sequence>/skeleton_pos.txt (SBU), ",
      "<class>/<sequence>.txt (K3HI) or a dataset.json, got none; see docs/datasets.md"));
}

}  // namespace duet::dataset
