#include "client/client.h"

#include "client/internal/connect.h"

namespace duet::client {

absl::StatusOr<Client> Client::Create(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<Connection>> connection = internal::Connect(options);
  if (!connection.ok()) return connection.status();
  return Client(*std::move(connection));
}

}  // namespace duet::client
