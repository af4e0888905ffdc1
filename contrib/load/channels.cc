#include "contrib/load/channels.h"

#include <chrono>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "client/internal/connect.h"

namespace duet::contrib::load {

absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> OpenChannels(
    const client::ClientOptions& options, int connections) {
  client::ClientOptions own = options;
  own.own_connection = true;
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  const auto end = std::chrono::system_clock::now() + absl::ToChronoMicroseconds(options.deadline);
  for (int i = 0; i < connections; ++i) {
    absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = client::internal::OpenChannel(own);
    if (!channel.ok()) return channel.status();
    (*channel)->GetState(true);
    channels.push_back(*std::move(channel));
  }
  for (const auto& channel : channels) {
    if (channel->WaitForConnected(end)) continue;
    return absl::UnavailableError(absl::StrCat("no connection to ", options.server_address,
                                               " within ", absl::FormatDuration(options.deadline)));
  }
  return channels;
}

}  // namespace duet::contrib::load
