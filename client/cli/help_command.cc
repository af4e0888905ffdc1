#include "client/cli/help_command.h"

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "client/cli/command_table.h"
#include "client/cli/help_topics.h"
#include "model/base/nearest.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

bool IsTopic(const std::string& name) {
  for (const std::string& topic : HelpTopics()) {
    if (topic == name) return true;
  }
  return false;
}

ExitCode Explain(const std::string& topic, const CommandContext& context) {
  std::ostream& out = *context.environment.out;
  const FlagSet* command = FindCommand(context.program, topic);
  if (topic.empty()) {
    out << context.program.Help() << "\nTopics (duet help TOPIC):\n  " << HelpTopicNames() << "\n";
  } else if (command != nullptr) {
    out << command->Help(context.program.name());
  } else if (IsTopic(topic)) {
    out << TopicText(topic);
  } else {
    std::vector<std::string> known = CommandNames(context.program);
    for (std::string& name : HelpTopics()) known.push_back(std::move(name));
    *context.environment.err << "There is no command or topic " << base::Quoted(topic)
                             << base::DidYouMean(topic, known) << "\nTopics: " << HelpTopicNames()
                             << "\n";
    return kExitUsage;
  }
  return kExitDone;
}

}  // namespace

Command AddHelpCommand(FlagSet* program) {
  const auto topic = std::make_shared<std::string>();
  Command command;
  command.app = program->AddCommand("help", "Explain a command or a topic");
  command.app->Add("topic", topic.get(), "A command, or one of: " + HelpTopicNames())
      ->Form("TOPIC");
  command.run = [topic](const CommandContext& context) { return Explain(*topic, context); };
  command.uses_settings = false;
  return command;
}

}  // namespace duet::client::cli
