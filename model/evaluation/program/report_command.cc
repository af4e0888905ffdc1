#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/render_png.h"
#include "model/evaluation/report/report.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string results;
  std::string out;
  std::string title = "Duet: evaluation";
};

// Every figure as PNG too. Without the program that draws them, the report is whole all the same.
absl::Status RenderFigures(const report::Report& report, const fs::path& folder) {
  for (const report::ResultSection& section : report.sections) {
    for (const report::ResultFigure& figure : section.figures) {
      const absl::Status status =
          report::RenderPng(folder / (figure.name + ".svg"), folder / (figure.name + ".png"));
      if (absl::IsNotFound(status)) {
        std::cerr << "duet-eval: " << status.message()
                  << " (Debian: librsvg2-bin): no figure was written as PNG\n";
        return absl::OkStatus();
      }
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<std::vector<report::ResultSection>> sections =
      report::ReadSections(arguments.results);
  if (!sections.ok()) return sections.status();
  const report::Report report = {arguments.title, *std::move(sections)};
  absl::Status status = WriteReport(report, arguments.out);
  if (!status.ok()) return status;
  status = RenderFigures(report, arguments.out);
  if (!status.ok()) return status;
  std::cout << absl::StrCat(report.sections.size(),
                            " sections: ", (fs::path(arguments.out) / "index.html").string(),
                            " and report.md\n");
  return absl::OkStatus();
}

}  // namespace

void AddReportCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("report", "One HTML page and one Markdown file of all results");
  command
      ->add_option("--results", arguments->results, "folder that the other commands' --out named")
      ->required();
  command->add_option("--out", arguments->out, "folder of the report")->required();
  command->add_option("--title", arguments->title, "of the report")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
