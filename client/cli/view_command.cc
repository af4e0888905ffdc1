#include "client/cli/view_command.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/batch/set_item.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"
#include "client/cli/skeleton_file.h"
#include "client/cli/take.h"
#include "client/cli/take_flags.h"
#include "client/viewer/gallery.h"
#include "client/viewer/page.h"
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

constexpr char kSetFooter[] = R"(
An item of a data set: its folder, and the item's name or number.
  duet view set hug-kick --out page.html
)";

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

// "duet view SET ITEM"
bool IsOfSet(const ViewArguments& arguments) { return batch::IsSet(arguments.takes.takes.front()); }

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

std::string Subtitle(const nlohmann::ordered_json& record) {
  std::string text =
      absl::StrFormat("%s \u00b7 %d frames at %g Hz", record["model"].get<std::string>(),
                      record["frames"].get<int64_t>(), record["frame_rate_hz"].get<double>());
  if (record.contains("seed")) absl::StrAppend(&text, " \u00b7 seed ", record["seed"].dump());
  if (record.contains("split")) {
    absl::StrAppend(&text, " \u00b7 ", record["split"].get<std::string>());
  }
  return text;
}

absl::Status ViewItem(const ViewArguments& arguments, const ProgramEnvironment& environment) {
  const std::string& set = arguments.takes.takes.front();
  absl::StatusOr<batch::SetItem> item = batch::ReadSetItem(set, arguments.takes.takes.back());
  if (!item.ok()) return item.status();
  const std::string name = item->record["name"];
  viewer::PageContent content;
  content.pair = std::move(item->pair);
  content.bones = item->skeleton.bones;
  content.title = arguments.title.empty() ? name : arguments.title;
  content.subtitle = Subtitle(item->record);
  content.weights = batch::WeightsOf(item->record);
  const absl::StatusOr<std::string> page = RenderPage(content);
  if (!page.ok()) return page.status();
  return Write(arguments, *page, absl::StrCat("shown     ", name, " of ", set, "\n"), environment);
}

absl::Status RunView(const ViewArguments& arguments, const ProgramEnvironment& environment) {
  if (IsOfSet(arguments)) return ViewItem(arguments, environment);
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
            "Motions to show, at most 12; or a data set of duet batch and one of its items")
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
  command->Footer(absl::StrCat(kTakesFooter, kSetFooter));
  command->Check([command, arguments] {
    if (IsOfSet(*arguments) && arguments->takes.takes.size() != 2) {
      const size_t words = arguments->takes.takes.size();
      RejectFlag("files", words == 1
                              ? "expected a data set and one of its items, got only the data set"
                              : absl::StrCat("expected a data set and one of its items, got ",
                                             words - 1, " words after the data set"));
    }
    CheckTakes(*command, arguments->takes);
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
