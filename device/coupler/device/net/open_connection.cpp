// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/open_connection.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <type_traits>
#include <utility>

namespace coupler::device {
namespace {

/// No other message of a channel begins with it.
constexpr std::uint8_t client_tag = 'C';

/// The beginning; what is unread and unsent follows.
struct Head {
  std::uint8_t tag = client_tag;
  // 0 or 1: other bytes are no bool.
  std::uint8_t has_asked = 0;
  std::uint8_t has_written = 0;
  std::uint8_t is_tls = 0;
  std::uint16_t unread = 0;
  std::uint16_t unsent = 0;
  TlsPeer tls{};
};
static_assert(std::is_trivially_copyable_v<Head>);

}  // namespace

ShortText::ShortText(std::string_view text)
    : size_(static_cast<std::uint8_t>(std::min(text.size(), capacity))) {
  std::copy_n(text.begin(), size_, bytes_.begin());
}

bool send_client(int channel, const OpenConnection& client, Waits waits) {
  assert(sizeof(Head) + client.unread.size() + client.unsent.size() <= longest_client_message);
  Head head;
  head.has_asked = client.has_asked ? 1 : 0;
  head.has_written = client.has_written ? 1 : 0;
  head.is_tls = client.tls ? 1 : 0;
  head.unread = static_cast<std::uint16_t>(client.unread.size());
  head.unsent = static_cast<std::uint16_t>(client.unsent.size());
  if (client.tls) head.tls = *client.tls;
  return send_message(
      channel, {{reinterpret_cast<const std::uint8_t*>(&head), sizeof head}, client.unread, client.unsent},
      client.socket.get(), waits);
}

std::optional<OpenConnection> parse_client(Span<const std::uint8_t> message, Descriptor socket) {
  Head head;
  if (message.size() < sizeof head || message[0] != client_tag || !socket.is_open()) return std::nullopt;
  std::memcpy(&head, message.data(), sizeof head);
  const auto rest = message.from(sizeof head);
  if (rest.size() != std::size_t{head.unread} + head.unsent) return std::nullopt;
  if (head.unread > longest_unread || head.unsent > longest_unsent) return std::nullopt;
  if (!head.tls.name.is_good() || !head.tls.role.is_good()) return std::nullopt;
  OpenConnection client;
  client.socket = std::move(socket);
  client.has_asked = head.has_asked != 0;
  client.has_written = head.has_written != 0;
  if (head.is_tls != 0) client.tls = head.tls;
  client.unread.assign(rest.begin(), rest.begin() + head.unread);
  client.unsent.assign(rest.begin() + head.unread, rest.end());
  return client;
}

}  // namespace coupler::device
