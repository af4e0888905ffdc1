#include "client/cli/typed_labels.h"

#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "client/cli/motion_arguments.h"
#include "client/cli/value_syntax.h"
#include "model/base/text.h"

namespace duet::client::cli {

absl::StatusOr<live::LabelCommand> ParseTypedLabels(const std::string& line) {
  live::LabelCommand command;
  for (const absl::string_view word : absl::StrSplit(line, ' ', absl::SkipWhitespace())) {
    absl::StatusOr<ClassWeight> weight = ParseClassWeight(word);
    if (!weight.ok()) return weight.status();
    if (weight->interaction_class != "ease") {
      command.weights.push_back(*std::move(weight));
    } else if (weight->weight >= 0 && weight->weight <= 10) {
      command.ease = absl::Seconds(weight->weight);
    } else {
      return absl::InvalidArgumentError(
          absl::StrCat("ease: expected 0 to 10 seconds, got ", weight->weight));
    }
  }
  if (!command.weights.empty()) return command;
  return absl::InvalidArgumentError(
      absl::StrCat("expected labels such as hug=1 kick=0 ease=0.3, got ", base::Quoted(line)));
}

TypedLabels::TypedLabels(const LiveArguments& arguments, const ProgramEnvironment& environment,
                         live::LiveRun* run)
    : run_(run), err_(*environment.err) {
  if (arguments.from == kStandardStream || !environment.in_is_terminal) return;
  if (!environment.in_descriptor.has_value()) return;
  lines_ = live::ReadLinesOf(*environment.in_descriptor);
  reader_ = std::thread([this] { Read(); });
}

TypedLabels::~TypedLabels() {
  if (lines_ == nullptr) return;
  lines_->Stop();
  reader_.join();
}

void TypedLabels::Read() {
  for (;;) {
    const absl::StatusOr<std::optional<std::string>> line = lines_->Next();
    if (!line.ok() || !line->has_value()) return;
    const absl::StatusOr<live::LabelCommand> command = ParseTypedLabels(**line);
    const absl::Status status = command.ok() ? run_->ChangeLabels(*command) : command.status();
    if (!status.ok()) err_ << "duet: " << status.message() << "\n" << std::flush;
  }
}

}  // namespace duet::client::cli
