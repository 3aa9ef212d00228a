// SPDX-License-Identifier: Apache-2.0
// In place of certificates.cpp, certificate_check.cpp and coupler/host/cli/pin.cpp in a build without
// OpenSSL.
#include <string>

#include "coupler/cli/certificate_check.hpp"
#include "coupler/cli/commands.hpp"

namespace coupler::cli {
namespace {

void add_absent(Program& program, Exit& exit, const std::string& name, const std::string& summary) {
  auto command = program.add_command(name, summary + " (not in this build: no OpenSSL 3).");
  command.allow_extras();
  command.callback([&exit, name] {
    exit = complain(name, failed, "this program was built without OpenSSL 3",
                    "install libssl-dev and build it again");
  });
}

}  // namespace

void add_certificates(Program& program, Exit& exit) {
  add_absent(program, exit, "certificates", "Make keys and certificates");
}

void add_pin(Program& program, Exit& exit) {
  add_absent(program, exit, "pin", "Print the pin of a device's certificate");
}

CertificateFindings check_certificates(const Map& map) {
  if (!map.security.files.present() && !map.connection.tls.present()) return {};
  return {{"  certificates are not checked: this program was built without OpenSSL 3"}, {}};
}

}  // namespace coupler::cli
