#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "client/batch/text_values.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/motion_input.h"
#include "client/cli/output.h"
#include "client/viewer/page.h"
#include "model/base/file.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  std::vector<std::string> takes;            // "[NAME=]FILE"
  formats::Side leader_side = kDefaultSide;  // who leads in a file with two people
  InputArguments input;
  fs::path skeleton;  // empty: the 15 joints of sbu
  fs::path out;
  std::string title;  // empty: the takes' names
  bool quiet = false;
};

// A motion to show: one person, or a leader and a follower.
struct Take {
  std::string name;
  std::vector<fs::path> files;  // one, or the leader's and the follower's
  motion::Clip leader;
  std::optional<motion::Clip> follower;
  std::vector<std::string> notes;  // on how it was read
};

constexpr char kLeaderEnding[] = ".leader.bvh", kFollowerEnding[] = ".follower.bvh";

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// The name and the files of "[NAME=]FILE"; a text that is the name of a file denotes that file. The
// default name is the file's. pair.leader.bvh includes pair.follower.bvh beside it.
Take ParseTake(const std::string& text) {
  Take take;
  std::string file = text;
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && !Exists(text)) {
    take.name = text.substr(0, equals);
    file = text.substr(equals + 1);
  }
  take.files = {file};
  std::string name = fs::path(file).stem().string();
  if (absl::EndsWith(file, kLeaderEnding)) {
    name = fs::path(name).stem().string();
    const fs::path follower = absl::StrCat(absl::StripSuffix(file, kLeaderEnding), kFollowerEnding);
    if (Exists(follower)) take.files.push_back(follower);
  }
  if (take.name.empty()) take.name = name;
  return take;
}

// Reads the motions of a take's files.
absl::Status Read(const formats::ReadOptions& options, formats::Side leader_side, Take* take) {
  absl::StatusOr<ReadPeople> read = ReadAllPeople(take->files[0], options);
  if (!read.ok()) return read.status();
  std::vector<motion::Clip>& people = read->people;
  if (take->files.size() > 1) {
    absl::StatusOr<ReadPeople> other = ReadAllPeople(take->files[1], options);
    if (!other.ok()) return other.status();
    people = {std::move(people[0]), std::move(other->people[0])};
  } else if (people.size() > 1 && leader_side == formats::Side::kRight) {
    std::swap(people[0], people[1]);
  }
  take->notes = std::move(read->notes);
  take->leader = std::move(people[0]);
  if (people.size() < 2) return absl::OkStatus();
  if (people[1].frame_count() != take->leader.frame_count()) {
    return absl::InvalidArgumentError(
        absl::StrCat(take->files.back().string(), ": expected the leader's ",
                     take->leader.frame_count(), " frames, got ", people[1].frame_count()));
  }
  take->follower = std::move(people[1]);
  return absl::OkStatus();
}

// Reads the takes, except files that are the follower of another take.
absl::StatusOr<std::vector<Take>> ReadTakes(const ViewArguments& arguments,
                                            const motion::Skeleton& skeleton) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  std::vector<Take> takes;
  std::set<fs::path> followers;
  for (const std::string& text : arguments.takes) {
    takes.push_back(ParseTake(text));
    if (takes.back().files.size() > 1) followers.insert(takes.back().files[1]);
  }
  takes.erase(
      std::remove_if(takes.begin(), takes.end(),
                     [&followers](const Take& take) { return followers.count(take.files[0]) > 0; }),
      takes.end());
  for (Take& take : takes) {
    const absl::Status status = Read(*options, arguments.leader_side, &take);
    if (!status.ok()) return status;
  }
  return takes;
}

constexpr std::size_t kMaxNamesInTitle = 3;

constexpr char kFooter[] = R"(
Each FILE is a motion of one or two people. walk.leader.bvh includes walk.follower.bvh if that exists.
)";

std::string TitleOf(const std::vector<Take>& takes) {
  const std::size_t named = std::min(takes.size(), kMaxNamesInTitle);
  const std::string names =
      absl::StrJoin(takes.begin(), takes.begin() + static_cast<std::ptrdiff_t>(named), ", ",
                    [](std::string* out, const Take& take) { out->append(take.name); });
  return absl::StrCat(names, named < takes.size() ? ", ..." : "");
}

std::string Describe(const std::vector<Take>& takes) {
  std::string text;
  for (const Take& take : takes) {
    absl::StrAppend(&text, "shown     ", take.name, ": ",
                    absl::StrJoin(take.files, " and ",
                                  [](std::string* joined, const std::filesystem::path& file) {
                                    joined->append(file.string());
                                  }),
                    take.follower ? "" : " (one person)", "\n");
    for (const std::string& note : take.notes) absl::StrAppend(&text, "          ", note, "\n");
  }
  return text;
}

absl::Status RunView(const ViewArguments& arguments, const ProgramEnvironment& environment) {
  const absl::StatusOr<motion::Skeleton> skeleton = SkeletonOf(arguments.skeleton);
  if (!skeleton.ok()) return skeleton.status();
  const absl::StatusOr<std::vector<Take>> takes = ReadTakes(arguments, *skeleton);
  if (!takes.ok()) return takes.status();
  viewer::GalleryContent content;
  for (const Take& take : *takes) {
    content.motions.push_back({take.name, take.leader, take.follower});
  }
  content.bones = skeleton->bones;
  content.title = arguments.title.empty() ? TitleOf(*takes) : arguments.title;
  content.subtitle =
      absl::StrCat(takes->size(), takes->size() == 1 ? " motion" : " motions side by side");
  const absl::StatusOr<std::string> page = RenderGallery(content);
  if (!page.ok()) return page.status();
  const absl::Status status = NotWritten(base::WriteFile(arguments.out, *page));
  if (status.ok() && !arguments.quiet) {
    *environment.out << Describe(*takes) << "wrote     " << arguments.out.string() << "\n";
  }
  return status;
}

void CheckPage(const fs::path& page) {
  const std::string extension = absl::AsciiStrToLower(page.extension().string());
  if (extension != ".html" && extension != ".htm") {
    RejectFlag("--out",
               absl::StrCat(page.string(), ": extension: expected .html, got \"", extension, "\""));
  }
  const absl::Status status = CheckOutput(page, {});
  if (!status.ok()) RejectFlag("--out", std::string(status.message()));
}

void AddFlags(CLI::App* command, ViewArguments* arguments) {
  command->add_option("files", arguments->takes, "Motions to show, at most 12")
      ->required()
      ->expected(1, 12)
      ->type_name("[NAME=]FILE");
  AddParsed(command, kInputGroup, "--leader-side", "left|right", batch::ParseSide,
            &arguments->leader_side, "The person who leads in a file with two people")
      ->default_str("left");
  AddInputFlags(command, &arguments->input);
  AddSkeletonFlag(command, &arguments->skeleton);
  AddValue(command, kOutputGroup, "--out", "FILE", &arguments->out, "Page to write, .html")
      ->required();
  AddValue(command, kOutputGroup, "--title", "TEXT", &arguments->title, "Title of the page");
  command->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kOutputGroup);
  command->footer(kFooter);
  command->callback([arguments] { CheckPage(arguments->out); });
}

}  // namespace

Command AddViewCommand(CLI::App* program) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* app = program->add_subcommand("view", "Make a page that plays motions side by side");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunView);
}

}  // namespace duet::client::cli
