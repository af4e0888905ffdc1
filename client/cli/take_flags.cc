#include "client/cli/take_flags.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"

namespace duet::client::cli {

void AddTakeFlags(FlagSet* app, TakeArguments* takes) {
  app->AddListReader(
         "--leader-side",
         [takes](const std::vector<std::string>& sides) {
           takes->leader_sides.clear();
           for (const std::string& side : sides) takes->leader_sides.push_back(kSides.at(side));
         },
         "The person who leads in a file with two people; once for all files, or once for each")
      ->OneOf({"left", "right"})
      ->OneValueEach()
      ->Form("left|right")
      ->ShowDefault("left")
      ->Group(kInputGroup);
  AddInputFlags(app, &takes->input);
}

void CheckTakes(const TakeArguments& takes) {
  const std::size_t sides = takes.leader_sides.size();
  if (sides != 1 && sides != takes.takes.size()) {
    RejectFlag("--leader-side", absl::StrCat("expected once or ", takes.takes.size(),
                                             " times, got ", sides, " times"));
  }
  int pipes = 0;
  for (const std::string& take : takes.takes) pipes += take == kStandardStream ? 1 : 0;
  if (pipes > 1) RejectFlag("FILE", "expected - once, got it twice");
}

void CheckPage(const char* flag, const std::filesystem::path& page) {
  if (page == kStandardStream) return;
  const std::string extension = absl::AsciiStrToLower(page.extension().string());
  if (extension != ".html" && extension != ".htm") {
    RejectFlag(flag,
               absl::StrCat(page.string(), ": extension: expected .html, got \"", extension, "\""));
  }
  const absl::Status status = CheckOutput(page, {});
  if (!status.ok()) RejectFlag(flag, std::string(status.message()));
}

}  // namespace duet::client::cli
