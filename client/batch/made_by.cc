#include "client/batch/made_by.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr char kCleanedUp[] = "cleaned_up";
constexpr char kEngine[] = "engine";
constexpr char kServerVersion[] = "server_version";

absl::string_view OnOrOff(bool on) { return on ? "on" : "off"; }

std::string TextOf(const ordered_json& record, const char* field) {
  const auto found = record.find(field);
  return found != record.end() && found->is_string() ? found->get<std::string>() : "";
}

// Keeps a text that becomes known later, and reports one that differs.
void Compare(const char* field, const std::string& now, std::string* first,
             std::vector<std::string>* differences) {
  if (first->empty()) *first = now;
  if (now.empty() || now == *first) return;
  differences->push_back(
      absl::StrCat(field, ": expected ", base::Quoted(*first), ", got ", base::Quoted(now)));
}

}  // namespace

MadeBy MadeByOf(const SynthesisResult& result) {
  return {result.cleaned_up, result.engine, result.server_version};
}

std::optional<MadeBy> MadeByOf(const ordered_json& record) {
  const auto cleaned_up = record.find(kCleanedUp);
  if (cleaned_up == record.end() || !cleaned_up->is_boolean()) return std::nullopt;
  return MadeBy{cleaned_up->get<bool>(), TextOf(record, kEngine), TextOf(record, kServerVersion)};
}

void AddMadeBy(const MadeBy& made_by, ordered_json* record) {
  (*record)[kCleanedUp] = made_by.cleaned_up;
  if (!made_by.engine.empty()) (*record)[kEngine] = made_by.engine;
  if (!made_by.server_version.empty()) (*record)[kServerVersion] = made_by.server_version;
}

absl::Status Makers::Check(const std::string& model, const MadeBy& made_by) {
  std::vector<std::string> differences;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    MadeBy& first = first_.try_emplace(model, made_by).first->second;
    if (first.cleaned_up != made_by.cleaned_up) {
      differences.push_back(absl::StrCat("clean_up: expected ", OnOrOff(first.cleaned_up), ", got ",
                                         OnOrOff(made_by.cleaned_up)));
    }
    Compare(kEngine, made_by.engine, &first.engine, &differences);
    Compare(kServerVersion, made_by.server_version, &first.server_version, &differences);
  }
  if (differences.empty()) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "model ", model, ": an answer was made in another way than the set's first one: ",
      absl::StrJoin(differences, "; ")));
}

absl::Status Makers::CheckRecord(const ordered_json& record) {
  const std::optional<MadeBy> made_by = MadeByOf(record);
  return made_by.has_value() ? Check(TextOf(record, "model"), *made_by) : absl::OkStatus();
}

}  // namespace duet::client::batch
