#include <iostream>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/clean_up_table.h"
#include "model/evaluation/report/data_tables.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  std::string out;
  std::string id = "05_data";
  std::string title = "The captures: tilt, noise, leaders";
};

absl::Status Run(const Arguments& arguments) {
  const absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  report::ResultSection section;
  section.id = arguments.id;
  section.title = arguments.title;
  section.text = {
      "What the data is like that everything else learns from and is measured on. The captures are "
      "levelled set by set as they are read; figures in SBU's raw unit are taken in the world as "
      "captured."};
  section.tables = {report::LeanTable(*dataset), report::FloorTable(*dataset),
                    report::NoiseTable(*dataset), report::LeaderTable(*dataset),
                    report::CleanUpTable(*dataset)};
  section.settings = {
      {"data", absl::StrCat(dataset->name, ", ", dataset->sequences.size(), " sequences")}};
  section.command = "duet-eval data --data DIR";
  section.date = report::Today();
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return arguments.out.empty() ? absl::OkStatus() : WriteSection(section, arguments.out);
}

}  // namespace

void AddDataCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("data",
                                          "Tilt, noise and leaders of a data set, before and after "
                                          "reading, and what clean-up does to it");
  command->add_option("--data", arguments->data, "folder of captures (docs/datasets.md)")
      ->required();
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report");
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program
