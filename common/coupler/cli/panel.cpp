// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/device_argument.hpp"
#include "coupler/cli/live_device.hpp"
#include "coupler/map/network.hpp"

namespace coupler::cli {
namespace {

struct Arguments {
  DeviceArgument device;
  PanelOptions panel;
  std::optional<std::uint16_t> port;
  std::optional<std::string> certificate;
  std::optional<std::string> key;
};

bool is_loopback(std::string_view address) {
  const auto parsed = parse_network(address);
  return parsed && (parse_network("127.0.0.0/8")->contains(parsed->address) ||
                    parse_network("::1")->contains(parsed->address));
}

Exit run(const Arguments& arguments) {
  PanelOptions options = arguments.panel;
  options.port = arguments.port.value_or(0);
  if (!is_ip_address(options.listen))
    return complain("panel", bad_call, "--listen: '" + options.listen + "' is not an IP address",
                    "give one of this machine's, or 0.0.0.0 for all of them");
  options.certificate = arguments.certificate.value_or("");
  options.key = arguments.key.value_or("");
  if ((arguments.certificate || arguments.key) && (options.certificate.empty() || options.key.empty()))
    return complain("panel", bad_call, "HTTPS needs a certificate and its key",
                    "give both --page-certificate FILE and --page-key FILE");
  if (options.write && options.certificate.empty() && !is_loopback(options.listen))
    return complain("panel", bad_call, "--write over a network needs HTTPS, or who reads along has the key",
                    "give --page-certificate FILE and --page-key FILE; or leave --listen out, give --port "
                    "8502, and on the other machine run `ssh -L 8502:127.0.0.1:8502 USER@THIS_MACHINE` and "
                    "open the address there");
  if (options.write && options.certificate.empty() && !options.name.empty() && options.name != "localhost")
    return complain(
        "panel", bad_call,
        "--write with --name needs HTTPS: by plain HTTP and a name, a browser's pages cannot tell how "
        "many they are, and of too many none can write",
        "leave --name out, or give --page-certificate FILE and --page-key FILE");
  return panel(arguments.device, options);
}

}  // namespace

void add_panel(Program& program, Exit& exit) {
  auto command =
      program.add_command("panel", "Show a device's points live, as a page in a browser, until Ctrl-C.");
  const auto arguments = std::make_shared<Arguments>();
  arguments->device.may_be_unknown = true;
  add_device_options(command, arguments->device);
  command.add_option("--port", arguments->port, "Port of the page (default: any free one)");
  command
      .add_option("--listen", arguments->panel.listen,
                  "IP address at which the page is served, for browsers on other machines")
      .show_default()
      .type_name("ADDRESS");
  command
      .add_option("--name", arguments->panel.name,
                  "What browsers may call this machine besides its address, as press.local")
      .type_name("NAME");
  command
      .add_option("--page-certificate", arguments->certificate,
                  "Serve the page by HTTPS: the PEM file of a certificate for this machine")
      .path()
      .type_name("FILE");
  command.add_option("--page-key", arguments->key, "The file of its key").path().type_name("FILE");
  command.add_flag("--write", arguments->panel.write,
                   "Pages may write to the device; without it nothing is ever written");
  command.add_flag("--field", arguments->panel.field,
                   "Of a node that runs with --sim: the other side of its terminals. With --write its inputs "
                   "can be set, and its outputs are only shown");
  command.footer(
      "Example:\n  coupler panel 192.168.1.20\n  coupler panel press.yaml --at 192.168.1.20 --port "
      "8502\n  coupler panel 127.0.0.1:1502 --field --write");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
