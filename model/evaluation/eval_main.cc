// duet-eval: measures trained models and baselines on captures.
#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/engine/torch_synthesizer.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/protocol.h"
#include "model/evaluation/synthesizer_method.h"

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string data;
  std::string runs;
  std::string checkpoint;
  bool embedded = false;
  bool as_served = false;
  std::vector<std::string> baselines = {"class_mean", "frozen_first_frame"};
  std::vector<std::string> subjects;
  std::vector<std::string> metrics = {"afd", "afd_squared"};
};

using Folds = std::vector<duet::FoldResult>;
using MakeMethod =
    std::function<absl::StatusOr<std::unique_ptr<duet::Method>>(const std::string& subject)>;

// The only checkpoint below a run's folder, <run>/checkpoint/<name>/<version>.
absl::StatusOr<fs::path> FindCheckpoint(const fs::path& run) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& name : fs::directory_iterator(run / "checkpoint", error)) {
    for (const auto& version : fs::directory_iterator(name.path(), error)) {
      found.push_back(version.path());
    }
  }
  if (found.size() == 1) return found[0];
  return absl::NotFoundError(absl::StrCat(run.string(), ": ", found.size(),
                                          " checkpoints, wanted one finished run of duet-train"));
}

absl::StatusOr<Folds> RunFolds(const duet::Dataset& dataset,
                               const std::vector<std::string>& subjects, const MakeMethod& make) {
  Folds folds;
  for (const std::string& subject : subjects) {
    absl::StatusOr<duet::Split> split = duet::LeaveSubjectOut(dataset, subject);
    if (!split.ok()) return split.status();
    absl::StatusOr<std::unique_ptr<duet::Method>> method = make(subject);
    if (!method.ok()) return method.status();
    absl::StatusOr<duet::FoldResult> fold = duet::RunFold(dataset, *split, subject, method->get());
    if (!fold.ok()) return fold.status();
    folds.push_back(*std::move(fold));
  }
  return folds;
}

// Rows of one table, by metric.
class Report {
 public:
  Report(const duet::Dataset& dataset, std::vector<std::string> metrics)
      : dataset_(dataset), metrics_(std::move(metrics)) {}

  void Add(const std::string& row, const Folds& folds) {
    rows_.emplace_back(row, duet::ScoreByClass(dataset_, duet::PoolMotions(folds)));
  }

  void Print(std::ostream& out) const {
    for (const std::string& metric : metrics_) PrintMetric(metric, out);
  }

 private:
  void PrintMetric(const std::string& metric, std::ostream& out) const {
    size_t column = 0;
    while (duet::MetricName(duet::AllMetrics()[column]) != metric) ++column;
    out << absl::StrFormat("\n%-24s", metric);
    for (const std::string& name : dataset_.classes) out << absl::StrFormat(" %15s", name);
    out << absl::StrFormat(" %15s\n", "mean");
    for (const auto& [row, scores] : rows_) {
      out << absl::StrFormat("%-24s", row);
      double sum = 0;
      for (const std::vector<double>& one : scores) {
        out << absl::StrFormat(" %15.4f", one[column]);
        sum += one[column];
      }
      out << absl::StrFormat(" %15.4f\n", sum / static_cast<double>(scores.size()));
    }
  }

  const duet::Dataset& dataset_;
  std::vector<std::string> metrics_;
  std::vector<std::pair<std::string, std::vector<std::vector<double>>>> rows_;
};

absl::Status AddModel(const duet::Dataset& dataset, const std::vector<std::string>& subjects,
                      const std::function<absl::StatusOr<std::shared_ptr<const duet::Synthesizer>>(
                          const std::string&)>& load,
                      const std::string& name, Report* report) {
  const std::pair<std::string, duet::StartGiven> rows[] = {
      {name, duet::StartGiven::kNone},
      {name + "+root", duet::StartGiven::kRoot},
      {name + "+pose", duet::StartGiven::kPose}};
  for (const auto& [row, start] : rows) {
    const auto make =
        [&, &row = row, start = start](
            const std::string& subject) -> absl::StatusOr<std::unique_ptr<duet::Method>> {
      absl::StatusOr<std::shared_ptr<const duet::Synthesizer>> synthesizer = load(subject);
      if (!synthesizer.ok()) return synthesizer.status();
      return std::make_unique<duet::SynthesizerMethod>(row, *synthesizer, start);
    };
    absl::StatusOr<Folds> folds = RunFolds(dataset, subjects, make);
    if (absl::IsFailedPrecondition(folds.status()) && start != duet::StartGiven::kNone) break;
    if (!folds.ok()) return folds.status();
    report->Add(row, *folds);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::shared_ptr<const duet::Synthesizer>> Load(const Arguments& arguments,
                                                              const std::string& subject) {
  const duet::TorchSynthesizerOptions options{arguments.as_served, arguments.as_served};
  if (arguments.embedded) {
    absl::StatusOr<std::vector<std::unique_ptr<duet::Synthesizer>>> all =
        duet::LoadEmbeddedSynthesizers(options);
    if (!all.ok()) return all.status();
    return std::shared_ptr<const duet::Synthesizer>(std::move(all->front()));
  }
  absl::StatusOr<fs::path> folder = arguments.checkpoint.empty()
                                        ? FindCheckpoint(fs::path(arguments.runs) / subject)
                                        : absl::StatusOr<fs::path>(arguments.checkpoint);
  if (!folder.ok()) return folder.status();
  absl::StatusOr<std::unique_ptr<duet::Synthesizer>> one =
      duet::LoadTorchSynthesizer(*folder, options);
  if (!one.ok()) return one.status();
  return std::shared_ptr<const duet::Synthesizer>(*std::move(one));
}

absl::Status Evaluate(const Arguments& arguments) {
  absl::StatusOr<duet::Dataset> dataset = duet::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  const std::vector<std::string> subjects =
      arguments.subjects.empty() ? dataset->Subjects() : arguments.subjects;
  Report report(*dataset, arguments.metrics);
  for (const std::string& name : arguments.baselines) {
    absl::StatusOr<Folds> folds =
        RunFolds(*dataset, subjects, [&](const std::string&) { return duet::MakeBaseline(name); });
    if (!folds.ok()) return folds.status();
    report.Add(name, *folds);
  }
  const bool has_model =
      arguments.embedded || !arguments.runs.empty() || !arguments.checkpoint.empty();
  if (has_model) {
    absl::Status status = AddModel(
        *dataset, subjects, [&](const std::string& s) { return Load(arguments, s); }, "duet",
        &report);
    if (!status.ok()) return status;
  }
  std::cout << dataset->name << ", leave one subject out over " << subjects.size()
            << " subjects; afd in SBU's raw unit (paper Eq. 6), afd_squared its square\n";
  if (arguments.embedded || !arguments.checkpoint.empty()) {
    std::cout
        << "NOTE: one checkpoint for every fold: it may have been trained on what is tested\n";
  }
  report.Print(std::cout);
  return absl::OkStatus();
}

std::vector<std::string> MetricNames() {
  std::vector<std::string> names;
  for (duet::Metric metric : duet::AllMetrics()) names.push_back(duet::MetricName(metric));
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Measures trained models and baselines on captures, leaving one subject out.");
  app.add_option("--data", arguments.data, "folder of captures (docs/datasets.md)")->required();
  auto* source = app.add_option_group("model", "what to measure besides the baselines");
  source->add_option("--runs", arguments.runs, "output of duet-train --protocol loso");
  source->add_option("--checkpoint", arguments.checkpoint, "one checkpoint folder for every fold");
  source->add_flag("--embedded", arguments.embedded, "the checkpoint inside this program");
  source->require_option(0, 1);
  app.add_flag(
      "--as_served", arguments.as_served,
      "with constant limb lengths on the leader's floor, as a server answers (default: the "
      "network's own answer)");
  app.add_option("--baselines", arguments.baselines, "rows beside it")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--subjects", arguments.subjects, "folds; default: every subject")->delimiter(',');
  app.add_option("--metrics", arguments.metrics, "tables to print")
      ->delimiter(',')
      ->check(CLI::IsMember(MetricNames()))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  duet::SetTorchThreads(1);
  const absl::Status status = Evaluate(arguments);
  if (status.ok()) return 0;
  std::cerr << "duet-eval: " << status.message() << "\n";
  return 1;
}
