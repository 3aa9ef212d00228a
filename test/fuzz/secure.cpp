// SPDX-License-Identifier: Apache-2.0
// What strangers say before a node knows who they are: a role in a certificate is text that fills its
// extension, and a client that the TLS process hands over is one that a connection can take, or none.
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/codec/text.hpp"
#include "coupler/credentials/role_extension.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/map/security.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

void check_role(Span<const std::uint8_t> extension) {
  const auto role = parse_role(extension);
  if (!role) return;
  require(!role->empty() && role->size() <= longest_role_name, "a role has 1 to 64 bytes");
  require(codec::is_plain_text(*role), "and no control characters");
  require(role->size() + 2 == extension.size(), "it fills its extension");
}

void check_client(Span<const std::uint8_t> message) {
  const auto client = device::parse_client(message, Descriptor(::dup(STDERR_FILENO)));
  if (!client) return;
  require(client->unread.size() <= device::longest_unread, "what is unread fits into a connection");
  require(client->unsent.size() <= device::longest_unsent, "and so does what is unsent");
  if (!client->tls) return;
  require(client->tls->name.view().size() <= device::ShortText::capacity, "a name is as long as it may be");
  require(client->tls->role.view().size() <= device::ShortText::capacity, "and so is a role");
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const coupler::Span<const std::uint8_t> bytes(data, size);
  coupler::fuzz::check_role(bytes);
  coupler::fuzz::check_client(bytes);
  return 0;
}
