#include "client/cli/view_command.h"

#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"
#include "client/cli/skeleton_file.h"
#include "client/cli/take.h"
#include "client/cli/take_flags.h"
#include "client/viewer/gallery.h"
#include "model/base/file.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {
namespace {

struct ViewArguments {
  TakeArguments takes;
  std::filesystem::path skeleton;  // empty: the 15 joints of sbu
  std::filesystem::path out;
  std::string title;  // empty: the takes' names
  bool quiet = false;
};

constexpr std::size_t kMostNamesInTitle = 3;

std::string TitleOf(const std::vector<Take>& takes) {
  std::vector<std::string> names;
  for (const Take& take : takes) {
    if (names.size() < kMostNamesInTitle) names.push_back(take.name);
  }
  std::string title = absl::StrJoin(names, ", ");
  if (takes.size() > names.size()) {
    absl::StrAppend(&title, " and ", takes.size() - names.size(), " more");
  }
  return title;
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

absl::Status Write(const ViewArguments& arguments, const std::string& page,
                   const std::string& report, const ProgramEnvironment& environment) {
  const bool to_stream = arguments.out == kStandardStream;
  const absl::Status status = to_stream ? WriteToStream(page, *environment.out)
                                        : NotWritten(base::WriteFile(arguments.out, page));
  if (status.ok() && !arguments.quiet) {
    (to_stream ? *environment.err : *environment.out)
        << report << "wrote     " << arguments.out.string() << "\n";
  }
  return status;
}

absl::Status RunView(const ViewArguments& arguments, const ProgramEnvironment& environment) {
  const absl::StatusOr<motion::Skeleton> skeleton = SkeletonOf(arguments.skeleton);
  if (!skeleton.ok()) return skeleton.status();
  const absl::StatusOr<std::vector<Take>> takes =
      ReadTakes(arguments.takes, *skeleton, environment.in);
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
  return Write(arguments, *page, Describe(*takes), environment);
}

void AddFlags(FlagSet* command, ViewArguments* arguments) {
  command
      ->Add("files", &arguments->takes.takes,
            "Motions to show, at most 12")
      ->Required()
      ->Count(1, 12)
      ->Form("[NAME=]FILE");
  AddTakeFlags(command, &arguments->takes);
  AddSkeletonFlag(command, &arguments->skeleton);
  command->Add("--out", &arguments->out, "Page to write, .html; - for standard output")
      ->Required()
      ->Form("FILE")
      ->Group(kOutputGroup);
  command->Add("--title", &arguments->title, "Title of the page")
      ->Form("TEXT")
      ->Group(kOutputGroup);
  command->AddSwitch("--quiet", &arguments->quiet, "Print only errors")->Group(kOutputGroup);
  command->Footer(kTakesFooter);
  command->Check([command, arguments] {
    CheckTakes(arguments->takes);
    CheckPage("--out", arguments->out);
  });
}

}  // namespace

Command AddViewCommand(FlagSet* program) {
  const auto arguments = std::make_shared<ViewArguments>();
  FlagSet* app = program->AddCommand("view", "Make a page that plays motions side by side");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunView);
}

}  // namespace duet::client::cli
