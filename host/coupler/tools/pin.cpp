// SPDX-License-Identifier: Apache-2.0
// coupler pin: the pin of a device's certificate.
#include <poll.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coupler/credentials/credentials.hpp"
#include "coupler/host/modbus/open_socket.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/tls/context.hpp"
#include "coupler/tls/stream.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  std::string host;
  double timeout = 3;  ///< s
};

/// Shakes hands until the device has shown its certificate. It will refuse a client without one after that.
void look(tls::Stream& stream, int socket, const host::Deadline& deadline) {
  for (;;) {
    const tls::Stream::Progress shaken = stream.shake_hands();
    pollfd wanted{socket, shaken.wants, 0};
    if (shaken.wants == 0 || stream.verification().seen || ::poll(&wanted, 1, deadline.left()) == 0) return;
  }
}

Exit pin_of_file(const std::string& path) {
  const auto text = read_pem_file("certificate", path, {});
  if (!text) return complain("pin", bad_input, text.error(), {});
  const auto pins = tls::pins_in(*text);
  if (!pins) return complain("pin", bad_input, path + ": " + pins.error(), {});
  if (pins->empty())
    return complain("pin", bad_input, path + " has no PEM certificate", "give the file of a certificate");
  for (const auto& [pin, key] : *pins)
    fmt::print("{}{}\n", tls::pin_text(pin), pins->size() == 1 ? "" : fmt::format("  # with {}", key));
  return ok;
}

/// Also one that is not there.
bool names_a_file(const std::string& place) {
  constexpr std::string_view ending = ".pem";
  std::error_code ignored;
  const bool ends_so =
      place.size() > ending.size() && place.compare(place.size() - ending.size(), ending.size(), ending) == 0;
  return ends_so || std::filesystem::is_regular_file(place, ignored);
}

Exit run(const Arguments& arguments) {
  if (names_a_file(arguments.host)) return pin_of_file(arguments.host);
  const std::string address = names_a_node(arguments.host) ? arguments.host : "tls://" + arguments.host;
  const auto where = parse_node_address(address);
  if (!where) return complain("pin", bad_call, where.error().what, where.error().remedy);
  if (!where->tls)
    return complain("pin", bad_call, "only a device with TLS has a pin",
                    "give tls://HOST[:PORT], or HOST[:PORT]");
  const auto timeout = std::chrono::milliseconds(static_cast<long>(arguments.timeout * 1000));
  const host::Deadline deadline(timeout);
  const host::Event never;
  const auto socket = host::open_socket(std::string(where->host), where->port, timeout, never);
  if (!socket) return complain("pin", failed, to_string(socket.error()), "check that a device serves there");
  tls::Verification verification;
  verification.only_looks = true;
  tls::Stream stream(tls::Context::of_stranger(), socket->get(), std::move(verification));
  look(stream, socket->get(), deadline);
  const tls::Verification& shown = stream.verification();
  if (!shown.seen)
    return complain("pin", failed,
                    fmt::format("{} port {} shows no certificate{}{}", where->host, where->port,
                                stream.problem().empty() ? "" : ": ", stream.problem()),
                    "check that it speaks TLS at this port");
  fmt::print("{}\n", tls::pin_text(*shown.seen));
  fmt::print(stderr,
             "The certificate of '{}', as whoever answers at {} shows it: believe it only if `coupler pin` "
             "prints the "
             "same for the file on the device's own machine.\n",
             printable(shown.peer.name), where->host);
  return ok;
}

}  // namespace

void add_pin(Program& program, Exit& exit) {
  auto command = program.add_command(
      "pin", "Print the pin of the certificate that a device with TLS shows, for `tls: {pin: …}`.");
  const auto arguments = std::make_shared<Arguments>();
  command
      .add_option("PLACE", arguments->host,
                  "HOST[:PORT], with tls:// in front or not, or a certificate's file")
      .required()
      .type_name("");
  command.add_option("--timeout", arguments->timeout, "Longest wait, in seconds")
      .in_range(0.01, 60.0)
      .show_default()
      .type_name("S");
  command.footer(
      "Example:\n  coupler pin press\n  coupler pin press/press.pem\nExit status 3: it cannot be reached, or "
      "shows no certificate.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
