#include "model/evaluation/report/result_section.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/evaluation/report/section_json.h"

namespace duet::evaluation::report {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxFileBytes = size_t{64} << 20;

absl::Status Prefixed(const std::string& prefix, const absl::Status& status) {
  return {status.code(), absl::StrCat(prefix, ": ", status.message())};
}

absl::Status CheckSvg(const std::string& svg) {
  const bool is_whole = absl::StartsWith(svg, "<svg ") &&
                        absl::EndsWith(absl::StripTrailingAsciiWhitespace(svg), "</svg>");
  if (is_whole) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("begins with ", base::Quoted(svg.substr(0, 16)),
                                                 ", wanted one whole <svg> element"));
}

absl::StatusOr<ResultSection> ReadSection(const fs::path& file) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, kMaxFileBytes, "a section of results");
  if (!text.ok()) return text.status();
  absl::StatusOr<ResultSection> section = SectionFromJson(*text);
  if (!section.ok()) return Prefixed(file.string(), section.status());
  if (section->id != file.stem().string()) {
    return absl::InvalidArgumentError(absl::StrCat(
        file.string(), ": id: ", base::Quoted(section->id), ", wanted the file's own name"));
  }
  for (ResultFigure& figure : section->figures) {
    const fs::path svg_file = file.parent_path() / (figure.name + ".svg");
    absl::StatusOr<std::string> svg = base::ReadFile(svg_file, kMaxFileBytes, "an SVG figure");
    if (!svg.ok()) return svg.status();
    if (absl::Status status = CheckSvg(*svg); !status.ok()) {
      return Prefixed(svg_file.string(), status);
    }
    figure.svg = *std::move(svg);
  }
  return section;
}

absl::Status CheckFigureNames(const std::vector<ResultSection>& sections) {
  std::set<std::string> seen;
  for (const ResultSection& section : sections) {
    for (const ResultFigure& figure : section.figures) {
      if (seen.insert(figure.name).second) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(section.id, ".json: figures: ", base::Quoted(figure.name),
                       " is a figure of an earlier section, wanted a name of its own"));
    }
  }
  return absl::OkStatus();
}

// The folder's JSON files.
absl::StatusOr<std::vector<fs::path>> FindSections(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".json") files.push_back(it->path());
  }
  if (error) {
    return absl::NotFoundError(absl::StrCat(folder.string(), ": ", error.message(),
                                            ", wanted a folder of results (duet-eval --out)"));
  }
  if (files.empty()) {
    return absl::NotFoundError(
        absl::StrCat(folder.string(), ": no .json file, wanted results of duet-eval --out"));
  }
  return files;
}

}  // namespace

absl::Status WriteSection(const ResultSection& section, const fs::path& folder) {
  // What the reader would refuse must not be written: there is one set of rules.
  const std::string text = SectionToJson(section);
  if (absl::StatusOr<ResultSection> again = SectionFromJson(text); !again.ok()) {
    return Prefixed(absl::StrCat("section ", base::Quoted(section.id)), again.status());
  }
  std::error_code error;
  fs::create_directories(folder, error);
  // The figures first: a section never names one that is not there.
  for (const ResultFigure& figure : section.figures) {
    if (absl::Status status = CheckSvg(figure.svg); !status.ok()) {
      return Prefixed(absl::StrCat("figure ", base::Quoted(figure.name)), status);
    }
    absl::Status status = base::WriteFile(folder / (figure.name + ".svg"), figure.svg);
    if (!status.ok()) return status;
  }
  return base::WriteFile(folder / (section.id + ".json"), text);
}

absl::StatusOr<std::vector<ResultSection>> ReadSections(const fs::path& folder) {
  const absl::StatusOr<std::vector<fs::path>> files = FindSections(folder);
  if (!files.ok()) return files.status();
  std::vector<ResultSection> sections;
  for (const fs::path& file : *files) {
    absl::StatusOr<ResultSection> section = ReadSection(file);
    if (!section.ok()) return section.status();
    sections.push_back(*std::move(section));
  }
  std::sort(sections.begin(), sections.end(),
            [](const ResultSection& a, const ResultSection& b) { return a.id < b.id; });
  if (absl::Status status = CheckFigureNames(sections); !status.ok()) return status;
  return sections;
}

std::string Today() { return absl::FormatTime("%Y-%m-%d", absl::Now(), absl::UTCTimeZone()); }

}  // namespace duet::evaluation::report
