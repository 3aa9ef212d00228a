// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/net/message.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::device {

/// A text of at most 64 bytes, without a heap.
class ShortText {
 public:
  static constexpr std::size_t capacity = 64;
  ShortText() = default;
  /// Texts that are too long are cut.
  explicit ShortText(std::string_view text);
  std::string_view view() const { return {bytes_.data(), size_}; }
  /// False: it is not one, but bytes that came from elsewhere.
  bool is_good() const { return size_ <= capacity; }

 private:
  std::array<char, capacity> bytes_{};
  std::uint8_t size_ = 0;
};

/// The client at the other end of a TLS connection. The socket leads to the process that does TLS.
struct TlsPeer {
  sockaddr_storage address{};
  ShortText name;  ///< the common name of its certificate, for people
  ShortText role;  ///< empty: its certificate names none
};

/// A client that one process, or one map, hands over to the next.
struct OpenConnection {
  Descriptor socket;
  bool has_asked = false;              ///< Connection's
  bool has_written = false;            ///< ClientSession's
  std::optional<TlsPeer> tls{};        ///< nullopt: a client without TLS
  std::vector<std::uint8_t> unread{};  ///< received, not answered; at most longest_unread
  std::vector<std::uint8_t> unsent{};  ///< replies that the client has not taken; at most longest_unsent
};

constexpr std::size_t longest_unread = modbus::max_adu_size;
/// Replies are sent together, a few long ones or many short ones.
constexpr std::size_t longest_unsent = 4 * modbus::max_adu_size;

/// The limit, in bytes, of what send_client() sends.
constexpr std::size_t longest_client_message = 4096;

/// Both processes have the connection then. False: it was not taken.
bool send_client(int channel, const OpenConnection& client, Waits waits);
/// nullopt: it is another message, or one that no connection can take over. Whoever sent it may be under
/// somebody else's control.
std::optional<OpenConnection> parse_client(Span<const std::uint8_t> message, Descriptor socket);

}  // namespace coupler::device
