#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "model/base/file.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/formats/flat/flat_files.h"
#include "model/importing/steps.h"
#include "model/motion/skeleton_json.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string LayoutText(const dataset::DatasetLayout& layout) {
  ordered_json classes = ordered_json::array();
  for (const dataset::ClassLayout& one : layout.classes) {
    std::vector<std::string> effectors;
    for (const int joint : one.effectors) {
      effectors.push_back(layout.skeleton.joint_names[static_cast<std::size_t>(joint)]);
    }
    ordered_json object = {{"name", one.name}};
    if (!effectors.empty()) object["effectors"] = effectors;
    if (one.symmetric) object["symmetric"] = true;
    if (one.handed) object["handed"] = true;
    if (one.touches) object["touches"] = true;
    classes.push_back(object);
  }
  ordered_json root = {{"name", layout.name},
                       {"frame_rate_hz", layout.frame_rate_hz},
                       {"unit", std::string(LengthUnitName(layout.coordinates.unit))},
                       {"up_axis", std::string(UpAxisName(layout.coordinates.up_axis))},
                       {"level", layout.level},
                       {"skeleton", SkeletonToJson(layout.skeleton, layout.parts)},
                       {"classes", classes}};
  if (layout.people_axis) root["people_axis"] = layout.people_axis->x != 0 ? "x" : "z";
  return root.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string PathOf(const ImportedSequence& sequence) {
  const PairFiles& files = sequence.capture.files;
  return absl::StrCat(files.label, "/", files.name, ".txt");
}

// Replaces characters of file names that would end a cell.
std::string Cell(const std::string& text) {
  return absl::StrReplaceAll(text, {{"\t", " "}, {"\n", " "}, {"\r", " "}});
}

std::string IndexText(const std::vector<ImportedSequence>& sequences) {
  std::string text = "path\tleader_side\tleader_source\tsubjects\tleft_file\tright_file\n";
  for (const ImportedSequence& sequence : sequences) {
    const PairFiles& files = sequence.capture.files;
    const char* const side = sequence.leader_side == dataset::LeaderSide::kRight ? "right" : "left";
    absl::StrAppend(&text, PathOf(sequence), "\t", side, "\t", sequence.leader_source, "\t",
                    Cell(absl::StrJoin(files.subjects, ",")), "\t", Cell(files.first), "\t",
                    Cell(files.second), "\n");
  }
  return text;
}

// The classes on a time line; empty if no sequence has one.
std::string TimeLinesText(const dataset::DatasetLayout& layout,
                          const std::vector<ImportedSequence>& sequences) {
  std::string text;
  for (const ImportedSequence& sequence : sequences) {
    for (const dataset::LabelSpan& span : sequence.labels) {
      absl::StrAppend(&text, PathOf(sequence), "\t",
                      layout.classes[static_cast<std::size_t>(span.interaction_class)].name, "\t",
                      span.begin / layout.frame_rate_hz, "\t", span.end / layout.frame_rate_hz,
                      "\n");
    }
  }
  return text.empty() ? text : absl::StrCat("path\tclass\tfrom_seconds\tto_seconds\n", text);
}

absl::Status WriteAll(const fs::path& folder, const dataset::DatasetLayout& layout,
                      const std::vector<ImportedSequence>& sequences) {
  formats::flat::SbuOptions options;
  options.joint_names = layout.skeleton.joint_names;
  options.frame_rate_hz = layout.frame_rate_hz;
  options.coordinates = layout.coordinates;
  std::set<std::string> written;
  for (const ImportedSequence& sequence : sequences) {
    const fs::path path = folder / PathOf(sequence);
    if (!written.insert(PathOf(sequence)).second) {
      return absl::InvalidArgumentError(absl::StrCat(PathOf(sequence),
                                                     ": expected one sequence of this name, got "
                                                     "two; rename ",
                                                     sequence.capture.files.first));
    }
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
      return absl::PermissionDeniedError(absl::StrCat(path.string(), ": ", error.message()));
    }
    DUET_TRY(const std::string text,
             FormatSbu({sequence.capture.first, sequence.capture.second}, options));
    DUET_RETURN_IF_ERROR(base::WriteFile(path, text));
  }
  DUET_RETURN_IF_ERROR(base::WriteFile(folder / "index.tsv", IndexText(sequences)));
  const std::string time_lines = TimeLinesText(layout, sequences);
  if (!time_lines.empty()) {
    DUET_RETURN_IF_ERROR(base::WriteFile(folder / "labels.tsv", time_lines));
  }
  return base::WriteFile(folder / "dataset.json", LayoutText(layout));
}

// A hidden folder next to `folder`.
fs::path Beside(const fs::path& folder, const std::string& purpose) {
  return folder.parent_path() / absl::StrCat(".", folder.filename().string(), ".", purpose);
}

absl::Status MoveThere(const fs::path& written, const fs::path& out) {
  const fs::path replaced = Beside(out, "replaced");
  std::error_code error;
  fs::remove_all(replaced, error);
  const bool replaces = fs::exists(out, error);
  if (replaces) fs::rename(out, replaced, error);
  if (!error) fs::rename(written, out, error);
  if (error) return absl::PermissionDeniedError(absl::StrCat(out.string(), ": ", error.message()));
  fs::remove_all(replaced, error);
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckOut(const fs::path& out, bool overwrite) {
  std::error_code error;
  if (!fs::exists(out, error)) {
    return fs::is_symlink(out, error) ? base::MissingFile(out, "folder") : absl::OkStatus();
  }
  if (!fs::is_directory(out, error)) {
    return absl::AlreadyExistsError(absl::StrCat(out.string(), ": expected a folder, got a file"));
  }
  if (fs::is_empty(out, error)) return absl::OkStatus();
  if (!fs::exists(out / "dataset.json", error)) {
    return absl::AlreadyExistsError(absl::StrCat(
        out.string(), ": expected a new folder or a data set, got a folder with other files"));
  }
  if (overwrite) return absl::OkStatus();
  return absl::AlreadyExistsError(absl::StrCat(
      out.string(), ": expected a new folder, got a data set; replace it with --overwrite"));
}

absl::Status WriteDataset(const fs::path& out, const dataset::DatasetLayout& layout,
                          const std::vector<ImportedSequence>& sequences) {
  const fs::path place = fs::absolute(out).lexically_normal();
  const fs::path folder = place.filename().empty() ? place.parent_path() : place;
  const fs::path written = Beside(folder, "importing");
  std::error_code error;
  fs::remove_all(written, error);  // left by an import that was killed
  fs::create_directories(written, error);
  if (error) {
    return absl::PermissionDeniedError(absl::StrCat(written.string(), ": ", error.message()));
  }
  absl::Status status = WriteAll(written, layout, sequences);
  if (status.ok()) status = dataset::ReadDataset(written).status();
  if (status.ok()) status = MoveThere(written, folder);
  fs::remove_all(written, error);
  return status;
}

}  // namespace duet::importing
