// consumer <server>: lists the models, then asks for the follower of a leader without frames and
// prints which fields were refused.
#include <iostream>

#include "duet/client/client.h"
#include "duet/client/error_details.h"

int main(int, char** argv) {
  duet::client::ClientOptions options;
  options.server_address = argv[1];
  const auto client = duet::client::Client::Create(options);
  const auto models = client.ok() ? client->ListModels() : client.status();
  if (!models.ok()) return std::cerr << models.status() << "\n", 1;
  for (const auto& model : *models) std::cout << model.name << "@" << model.version << "\n";

  duet::motion::Clip leader;
  leader.joint_names = models->front().joint_names;
  leader.frame_rate_hz = models->front().frame_rate_hz;
  duet::client::SynthesisRequest request;
  request.model.name = models->front().name;
  request.leader = leader;
  request.weights = {{models->front().interaction_classes.front(), 1}};
  const auto result = client->Synthesize(request);
  for (const auto& violation : duet::client::FieldViolations(result.status())) {
    std::cout << violation.field << "\n";
  }
}
