#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
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
  std::vector<std::string> takes;  // "[NAME=]FILE"
  InputArguments input;
  fs::path skeleton;  // empty: the 15 joints of sbu
  fs::path out;
  std::string title;  // empty: the takes' names
  bool quiet = false;
};

// A motion to show: one person, or a leader and a follower.
struct Take {
  std::string name;
  fs::path file;
  motion::Clip leader;
  std::optional<motion::Clip> follower;
  std::vector<std::string> notes;  // on how it was read
};

// The name and the file of "[NAME=]FILE"; a text that is the name of a file denotes that file. The
// default name is the file's.
Take ParseTake(const std::string& text) {
  Take take;
  const std::size_t equals = text.find('=');
  std::error_code error;
  const bool named = equals != std::string::npos && equals > 0 && !fs::exists(text, error);
  take.file = named ? text.substr(equals + 1) : text;
  take.name = named ? text.substr(0, equals) : take.file.stem().string();
  return take;
}

// Reads the motions of a take's file.
absl::Status Read(const formats::ReadOptions& options, Take* take) {
  absl::StatusOr<ReadPeople> read = ReadAllPeople(take->file, options);
  if (!read.ok()) return read.status();
  std::vector<motion::Clip>& people = read->people;
  take->notes = std::move(read->notes);
  take->leader = std::move(people[0]);
  if (people.size() > 1) take->follower = std::move(people[1]);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Take>> ReadTakes(const ViewArguments& arguments,
                                            const motion::Skeleton& skeleton) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  std::vector<Take> takes;
  for (const std::string& text : arguments.takes) {
    takes.push_back(ParseTake(text));
    const absl::Status status = Read(*options, &takes.back());
    if (!status.ok()) return status;
  }
  return takes;
}

std::string Describe(const std::vector<Take>& takes) {
  std::string text;
  for (const Take& take : takes) {
    absl::StrAppend(&text, "shown     ", take.name, ": ", take.file.string(),
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
  const auto append_name = [](std::string* out, const Take& take) { out->append(take.name); };
  content.title =
      arguments.title.empty() ? absl::StrJoin(*takes, ", ", append_name) : arguments.title;
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

void AddFlags(CLI::App* command, ViewArguments* arguments) {
  command->add_option("files", arguments->takes, "Motions of one or two people, at most 12")
      ->required()
      ->expected(1, 12)
      ->type_name("[NAME=]FILE");
  AddInputFlags(command, &arguments->input);
  AddSkeletonFlag(command, &arguments->skeleton);
  AddValue(command, kOutputGroup, "--out", "FILE", &arguments->out, "Page to write, .html")
      ->required();
  AddValue(command, kOutputGroup, "--title", "TEXT", &arguments->title, "Title of the page");
  command->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kOutputGroup);
  command->callback([arguments] {
    const absl::Status status = CheckOutput(arguments->out, {}, OutputKind::kPage);
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  });
}

}  // namespace

Command AddViewCommand(CLI::App* program) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* app = program->add_subcommand("view", "Make a page that plays motions side by side");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunView);
}

}  // namespace duet::client::cli
