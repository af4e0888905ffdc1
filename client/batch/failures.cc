#include "client/batch/failures.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr size_t kMaxCauses = 1000;
constexpr char kOther[] = "other causes";

std::string Text(const ordered_json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string Cell(absl::string_view text) {
  return absl::StrReplaceAll(text, {{"\t", " "}, {"\n", " "}, {"\r", " "}});
}

// Removes the file from "walks/a.bvh: no such file"; its path may begin with the manifest's folder.
absl::string_view WithoutFile(absl::string_view leader, absl::string_view message) {
  const std::string file = absl::StrCat(leader, ":");
  const size_t at = leader.empty() ? absl::string_view::npos : message.find(file);
  if (at == absl::string_view::npos) return message;
  // Only a path may precede the file name.
  if (message.substr(0, at).find(": ") != absl::string_view::npos) return message;
  return absl::StripLeadingAsciiWhitespace(message.substr(at + file.size()));
}

}  // namespace

bool AllowedFailures::Allows(int64_t failed_leaders, int64_t all_leaders) const {
  if (!share.has_value()) return failed_leaders <= leaders;
  return static_cast<double>(failed_leaders) <= *share * static_cast<double>(all_leaders);
}

absl::StatusOr<AllowedFailures> ParseAllowedFailures(absl::string_view text) {
  AllowedFailures allowed;
  absl::string_view number = text;
  if (absl::ConsumeSuffix(&number, "%")) {
    double percent = 0;
    if (absl::SimpleAtod(number, &percent) && percent >= 0 && percent <= 100) {
      allowed.share = percent / 100;
      return allowed;
    }
  } else if (absl::SimpleAtoi(number, &allowed.leaders) && allowed.leaders >= 0) {
    return allowed;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("expected a number of leaders, or a share of them from 0% to 100%, got ",
                   base::Quoted(text)));
}

ordered_json ToJson(const std::vector<FailureCause>& causes) {
  ordered_json array = ordered_json::array();
  for (const FailureCause& cause : causes) {
    array.push_back({{"code", cause.code},
                     {"message", cause.message},
                     {"items", cause.items},
                     {"leaders", cause.leaders}});
  }
  return array;
}

void FailureCauses::Add(absl::string_view leader, absl::string_view code, absl::string_view message,
                        int64_t items, int64_t leaders) {
  std::pair<std::string, std::string> cause(code, WithoutFile(leader, message));
  if (counts_.size() >= kMaxCauses && counts_.count(cause) == 0) cause = {"", kOther};
  auto& [all_items, all_leaders] = counts_[cause];
  all_items += items;
  all_leaders += leaders;
}

std::vector<FailureCause> FailureCauses::Largest(size_t count) const {
  std::vector<FailureCause> causes;
  for (const auto& [cause, counts] : counts_) {
    causes.push_back({cause.first, cause.second, counts.first, counts.second});
  }
  std::stable_sort(causes.begin(), causes.end(),
                   [](const FailureCause& a, const FailureCause& b) { return a.items > b.items; });
  if (causes.size() > count) causes.resize(count);
  return causes;
}

absl::Status FailureTable::Open() {
  absl::Status status = file_.Open();
  return status.ok() ? file_.Append("leader\titems\tcode\tmessage\tnames\n") : status;
}

absl::Status FailureTable::Add(const ordered_json& record) {
  const std::string leader = Text(record, "leader");
  if (leader != leader_) {
    absl::Status status = WriteLeader();
    if (!status.ok()) return status;
    leader_ = leader;
    leaders_.insert(leader);
  }
  const ordered_json error = record.value("error", ordered_json::object());
  names_[{Text(error, "code"), Text(error, "message")}].push_back(Text(record, "name"));
  return absl::OkStatus();
}

absl::Status FailureTable::WriteLeader() {
  absl::Status status;
  for (const auto& [error, names] : names_) {
    const auto items = static_cast<int64_t>(names.size());
    causes_.Add(leader_, error.first, error.second, items, 1);
    if (!status.ok()) continue;
    status = file_.Append(absl::StrCat(Cell(leader_), "\t", items, "\t", error.first, "\t",
                                       Cell(error.second), "\t", absl::StrJoin(names, ","), "\n"));
  }
  names_.clear();
  return status;
}

absl::Status FailureTable::Finish() {
  absl::Status status = WriteLeader();
  return status.ok() ? file_.Finish(path_) : status;
}

}  // namespace duet::client::batch
