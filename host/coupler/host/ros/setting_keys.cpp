// SPDX-License-Identifier: Apache-2.0
// Which settings there are.
#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/ros/settings.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::host {
namespace {

using Kind = SettingKey::Kind;

std::string nearest_setting(std::string_view name) {
  return nearest_or(name, setting_names(), "coupler_driver --help shows them");
}

}  // namespace

const std::array<SettingKey, 23> setting_keys{{
    {"map", "mapping", Kind::text, 0, 0, "",
     "the device's map: a YAML or JSON file, or the address of a node, as tcp:// or "
     "tls://HOST[:PORT][/UNIT]"},
    {"maps", "", Kind::list, 0, 0, "",
     "several devices in one process: their maps, as in --maps a.yaml,b.yaml; with names of their own, as in "
     "--maps left=io.yaml,right=io.yaml"},
    {"name", "", Kind::text, 0, 0, "", "namespace of the topics, instead of the map's"},
    {"address", "", Kind::text, 0, 0, "",
     "host name or IP address; alone, without a map: a node that serves its own"},
    {"port", "", Kind::integer, 1, 65535, "", "TCP port; 502 if the map has none"},
    {"unit", "", Kind::integer, 0, 255, "", "unit id"},
    {"framing", "", Kind::text, 0, 0, "", "tcp, or rtu for RTU over TCP"},
    {"serial", "", Kind::text, 0, 0, "", "serial port, as /dev/ttyUSB0, instead of an address"},
    {"baud", "", Kind::integer, 110, 4000000, "", "bits a second on the serial port"},
    {"parity", "", Kind::text, 0, 0, "", "even, odd or none"},
    {"stop_bits", "", Kind::integer, 1, 2, "", "stop bits on the serial port"},
    {"rs485", "", Kind::text, 0, 0, "", "true: the port's driver switches the direction of RS-485"},
    {"certificate", "", Kind::text, 0, 0, "", "file of this machine's certificate, for a coupler with TLS"},
    {"key", "", Kind::text, 0, 0, "", "file of its key"},
    {"ca", "", Kind::text, 0, 0, "", "file of the authority of the coupler's certificate"},
    {"tls_name", "", Kind::text, 0, 0, "", "name in the coupler's certificate, if not its address"},
    {"pin", "", Kind::text, 0, 0, "", "of the coupler's certificate, instead of ca: see coupler pin"},
    {"rate", "", Kind::real, 0.001, 10000, " Hz", "polling rate in Hz"},
    {"timeout", "", Kind::real, 0.001, 3600, " s", "longest wait for a reply, in seconds"},
    {"verify", "", Kind::text, 0, 0, "",
     "if the node's map differs: require (do not talk to it), warn (go on) or off (do not ask); instead of "
     "the "
     "map's"},
    {"poll", "", Kind::text, 0, 0, "",
     "which points are read: all (default), or subscribed: those that have subscribers; instead of the "
     "map's"},
    {"record", "", Kind::text, 0, 0, "",
     "file of a recording of every change, as `coupler record` makes it; of several devices each has its "
     "own"},
    {"panel", "", Kind::integer, 1, 65535, "",
     "port of a live page, as `coupler panel` shows it, on this machine; of several devices each has the "
     "next "
     "port"},
}};

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const SettingKey& key : setting_keys) {
    names.push_back(key.key);
    if (!key.alias.empty()) names.push_back(key.alias);
  }
  return names;
}

bool is_setting(std::string_view name) {
  const auto names = setting_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string no_such_setting(std::string_view name) {
  return "there is no such setting; " + nearest_setting(name);
}

std::string unknown_parameter(std::string_view parameter, std::string_view name) {
  return fmt::format("parameter {} is not a setting and does nothing; {}", parameter, nearest_setting(name));
}

}  // namespace coupler::host
