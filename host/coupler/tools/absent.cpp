// SPDX-License-Identifier: Apache-2.0
// Stubs for what this build lacks because a library was missing. Each command says what to install.
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "coupler/tools/certificate_check.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/live_map.hpp"

namespace coupler::tools {
namespace {

/// Adds a command that only says what is missing. `library` is the name that people use, and `packages` are
/// the names of the Debian packages.
void add_absent(Program& program, Exit& exit, const std::string& name, const std::string& summary,
                const std::string& library, const std::string& packages) {
  auto command = program.add_command(name, fmt::format("{} (not in this build: no {}).", summary, library));
  command.allow_extras();
  command.callback([&exit, name, library, packages] {
    exit = complain(name, failed, "this program was built without " + library,
                    fmt::format("install {} and build it again", packages));
  });
}

}  // namespace

#ifndef COUPLER_WITH_LIBMODBUS
void add_dump(Program& program, Exit& exit) {
  add_absent(program, exit, "dump", "Read every point of a device and show its value", "libmodbus",
             "libmodbus-dev");
}

void add_fetch(Program& program, Exit& exit) {
  add_absent(program, exit, "fetch", "Save the map that a node serves", "libmodbus", "libmodbus-dev");
}

void add_probe(Program& program, Exit& exit) {
  add_absent(program, exit, "probe", "Find out what a device answers to", "libmodbus", "libmodbus-dev");
}

void add_record(Program& program, Exit& exit) {
  add_absent(program, exit, "record", "Write every change of a device's points to a file", "libmodbus",
             "libmodbus-dev");
}

void add_status(Program& program, Exit& exit) {
  add_absent(program, exit, "status", "Show what a node says about itself", "libmodbus", "libmodbus-dev");
}

tl::expected<MapPtr, Failure> fetch_live_map(Connection /*where*/) {
  return fail(failed, "this program was built without libmodbus and cannot ask a device",
              "install libmodbus-dev and build it again, or give the map's file");
}
#endif

#ifndef COUPLER_WITH_PANEL
void add_panel(Program& program, Exit& exit) {
  add_absent(program, exit, "panel", "Show a device's points live, as a page in a browser",
             "cpp-httplib and/or libmodbus", "libcpp-httplib-dev and libmodbus-dev");
}
#endif

#ifndef COUPLER_WITH_TLS
void add_certificates(Program& program, Exit& exit) {
  add_absent(program, exit, "certificates", "Make keys and certificates", "OpenSSL 3", "libssl-dev");
}

CertificateFindings check_certificates(const Map& map) {
  if (!map.security.files.present() && !map.connection.tls.present()) return {};
  return {{"  certificates are not checked: this program was built without OpenSSL 3"}, {}};
}
#endif

#ifndef COUPLER_WITH_TLS
void add_pin(Program& program, Exit& exit) {
  add_absent(program, exit, "pin", "Print the pin of a device's certificate", "OpenSSL 3", "libssl-dev");
}
#elif !defined(COUPLER_WITH_LIBMODBUS)
void add_pin(Program& program, Exit& exit) {
  add_absent(program, exit, "pin", "Print the pin of a device's certificate", "libmodbus", "libmodbus-dev");
}
#endif

}  // namespace coupler::tools
