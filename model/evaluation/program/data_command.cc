#include <memory>
#include <string>

#include "model/dataset/dataset.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/clean_up_table.h"
#include "model/evaluation/report/data_tables.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  SectionFlags section = {"05_data", "The captures: tilt, noise, leaders"};
};

absl::Status Run(const Arguments& arguments) {
  const absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  report::ResultSection section = BeginSection(
      arguments.section,
      "Properties of the data set for training and evaluation. Each set of captures is levelled "
      "when it is read; figures in SBU's raw unit are measured before levelling.");
  section.tables = {report::LeanTable(*dataset), report::FloorTable(*dataset),
                    report::NoiseTable(*dataset), report::LeaderTable(*dataset),
                    report::CleanUpTable(*dataset)};
  section.settings = {{"data", DescribeData(*dataset)}};
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddDataCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand("data",
                                          "Tilt, noise and leaders of a data set, before and after "
                                          "reading, and the effect of clean-up");
  AddDataFlag(&arguments->data, command);
  AddSectionFlags(&arguments->section, command);
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
