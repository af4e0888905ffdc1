#include <iostream>

#include "duet/client/client.h"

int main(int, char** argv) {
  duet::client::ClientOptions options;
  options.server_address = argv[1];
  const auto client = duet::client::Client::Create(options);
  const auto models = client.ok() ? client->ListModels() : client.status();
  if (!models.ok()) return std::cerr << models.status() << "\n", 1;
  for (const auto& model : *models) std::cout << model.name << "@" << model.version << "\n";
}
