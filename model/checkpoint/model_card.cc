#include <cstddef>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "model/checkpoint/checkpoint.h"

namespace duet::checkpoint {
namespace {

// Entries of Manifest::training that describe the data. They are not listed with the settings.
constexpr const char* kDataNotes[] = {"data", "sequences", "seconds", "people", "levelled"};

bool IsDataNote(const std::string& key) {
  for (const char* note : kDataNotes) {
    if (key == note) return true;
  }
  return false;
}

std::string Note(const Manifest& manifest, const std::string& key) {
  const auto it = manifest.training.find(key);
  return it == manifest.training.end() ? "" : it->second;
}

int64_t ParameterCount(const Manifest& manifest) {
  int64_t count = 0;
  for (const TensorSpec& spec : ExpectedTensors(manifest)) {
    int64_t values = 1;
    for (const int64_t size : spec.shape) values *= size;
    count += values;
  }
  return count;
}

std::string Row(const std::string& name, const std::string& value) {
  return absl::StrCat("| ", name, " | ", absl::StrReplaceAll(value, {{"|", "\\|"}}), " |\n");
}

std::string Classes(const engine::ModelDescription& model) {
  std::string text = absl::StrJoin(model.classes, ", ");
  if (!model.touching_classes.empty()) {
    absl::StrAppend(&text, "; bodies may touch in ", absl::StrJoin(model.touching_classes, ", "));
  }
  return text;
}

std::string SkeletonText(const Manifest& manifest) {
  const motion::Skeleton& skeleton = manifest.model.skeleton;
  return absl::StrCat(
      skeleton.joint_count(), " joints about ",
      skeleton.joint_names[static_cast<std::size_t>(skeleton.root)], ", in ", manifest.parts.size(),
      " parts: ",
      absl::StrJoin(manifest.parts, ", ", [](std::string* out, const motion::BodyPart& part) {
        out->append(part.name);
      }));
}

std::string Kind(const Manifest& manifest) {
  return absl::StrCat(std::string(Summary(manifest.architecture)), "; ", ParameterCount(manifest),
                      " parameters");
}

std::string Data(const Manifest& manifest) {
  std::string text = absl::StrCat(Note(manifest, "data"), ": ", Note(manifest, "sequences"),
                                  " sequences of two people");
  if (const std::string seconds = Note(manifest, "seconds"); !seconds.empty()) {
    absl::StrAppend(&text, ", ", seconds, " s in total");
  }
  const std::string people = Note(manifest, "people");
  absl::StrAppend(&text, "; people: ", people.empty() ? "not named" : people);
  if (Note(manifest, "levelled") == "true") absl::StrAppend(&text, "; levelled");
  return text;
}

std::string Facts(const Manifest& manifest) {
  const engine::ModelDescription& model = manifest.model;
  return absl::StrCat(
      "| | |\n|---|---|\n", Row("classes", Classes(model)), Row("skeleton", SkeletonText(manifest)),
      Row("frame rate", absl::StrFormat("%g Hz; trained on windows of up to %d frames",
                                        model.frame_rate_hz, model.window_frames)),
      Row("generator", Kind(manifest)), Row("trained on", Data(manifest)),
      Row("made", absl::StrCat(manifest.created, ", by the code of revision ",
                               manifest.git_revision.empty() ? "unknown" : manifest.git_revision)),
      Row("weights", absl::StrCat("SHA-256 ", manifest.weights.sha256)));
}

std::string Figures(const Manifest& manifest) {
  std::string text;
  for (const auto& [name, value] : manifest.metrics) {
    text += Row(name, absl::StrFormat("%.4g", value));
  }
  if (!text.empty()) text = absl::StrCat("| figure | value |\n|---|---|\n", text);
  if (manifest.metrics.count("validation.afd") == 0) {
    absl::StrAppend(&text, text.empty() ? "" : "\n",
                    "No sequences were held out from training to validate the model.\n");
  }
  return text;
}

std::string Terms(const Manifest& manifest) {
  if (manifest.model.free_for_all_uses) {
    return absl::StrCat("Anybody may use and pass on the weights and their output for any purpose.",
                        manifest.model.terms.empty() ? "" : " ", manifest.model.terms);
  }
  if (!manifest.model.terms.empty()) return manifest.model.terms;
  const std::string data = Note(manifest, "data");
  return absl::StrCat("Terms: those of the data set ",
                      data.empty() ? "that it was trained on" : data,
                      " (complete this sentence before you distribute the model, and add it to "
                      "manifest.json as \"terms\").");
}

std::string Settings(const Manifest& manifest) {
  std::string text = "| setting | value |\n|---|---|\n";
  for (const auto& [key, value] : manifest.training) {
    if (!IsDataNote(key)) text += Row(key, value);
  }
  return text;
}

}  // namespace

std::string ModelCard(const Manifest& manifest) {
  const engine::ModelDescription& model = manifest.model;
  return absl::StrCat(
      "# ", model.name, ", version ", model.version, "\n\n",
      model.description.empty() ? "Synthesises a follower's motion from a leader's."
                                : model.description,
      "\n\n", Facts(manifest), "\n## Figures\n\n", Figures(manifest), "\n## Intended use\n\n",
      "Animation and research: synthesising the second character of an interaction of the classes\n"
      "above from the motion of the first. Not intended for identifying people or their\n"
      "intentions, or for controlling machines near people.\n",
      "\n## Limits\n\n",
      "The model covers what its data contains: those classes, clips of those lengths, and bodies\n"
      "like those captured. It also answers leaders unlike these; the summary of the reply\n"
      "reports how unfamiliar the leader is. It has no faces, fingers or objects.\n",
      "\n## Terms\n\n", Terms(manifest), "\n", "\n## Settings\n\n", Settings(manifest));
}

}  // namespace duet::checkpoint
