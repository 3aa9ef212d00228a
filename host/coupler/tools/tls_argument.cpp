// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/tls_argument.hpp"

namespace coupler::tools {

void add_tls_options(command_line::Command& command, TlsTexts& arguments) {
  command
      .add_option("--certificate", arguments.certificate, "With tls://: the file of this side's certificate")
      .path()
      .type_name("FILE");
  command.add_option("--key", arguments.key, "The file of its key").path().type_name("FILE");
  command.add_option("--ca", arguments.ca, "The file of the authority of the device's certificate")
      .path()
      .type_name("FILE");
  command.add_option("--tls-name", arguments.name, "The name in the device's certificate, if not its address")
      .type_name("NAME");
  command.add_option("--pin", arguments.pin, "In place of --ca: what `coupler pin` prints").type_name("PIN");
}

bool any_given(const TlsTexts& arguments) {
  return !(arguments.certificate + arguments.key + arguments.ca + arguments.name + arguments.pin).empty();
}

std::optional<std::string> tls_problem(const Tls& tls) {
  if (!tls.present() || !missing_key(tls).empty())
    return "give --certificate FILE and --key FILE, this side's own, and --ca FILE, the device's authority "
           "(or --pin)";
  if (!tls.ca.empty() && !tls.pin.empty())
    return "give --ca, the device's authority, or --pin, of its certificate, and not both";
  if (!tls.pin.empty() && !is_pin(tls.pin)) return "a pin is 'sha256:' and 64 hexadecimal digits";
  return std::nullopt;
}

std::optional<Failure> use_tls_options(const NodeAddress& where, const TlsTexts& arguments, Tls& tls) {
  if (!where.tls && any_given(arguments))
    return Failure{bad_call, "certificates are for a place with TLS", "write tls:// before the host"};
  if (!where.tls) return std::nullopt;
  overlay(tls, arguments.view());
  const auto missing = tls_problem(tls);
  if (!missing) return std::nullopt;
  return Failure{bad_call, "tls:// needs certificates", *missing};
}

}  // namespace coupler::tools
