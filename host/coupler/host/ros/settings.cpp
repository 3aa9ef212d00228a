// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/settings.hpp"

#include <string_view>

#include "coupler/map/tls_texts.hpp"

namespace coupler::host {
namespace {

template <class T>
void prefer(std::optional<T>& field, const std::optional<T>& strong) {
  if (strong) field = strong;
}

void apply(const Settings& settings, Tls& tls) {
  const auto text = [](const std::optional<std::string>& setting) {
    return setting ? std::string_view(*setting) : std::string_view();
  };
  overlay(tls, {text(settings.certificate),
                text(settings.key),
                text(settings.ca),
                text(settings.tls_name),
                text(settings.pin),
                {}});
}

}  // namespace

Settings overlay(Settings weak, const Settings& strong) {
  if (strong.map || !strong.maps.empty()) {
    weak.map = strong.map;
    weak.maps = strong.maps;
  }
  if (strong.serial) {
    weak.address.reset();
    weak.port.reset();
    weak.framing.reset();
  }
  if (strong.address) {
    weak.serial.reset();
    weak.baud.reset();
    weak.parity.reset();
    weak.stop_bits.reset();
    weak.rs485.reset();
  }
  prefer(weak.name, strong.name);
  prefer(weak.address, strong.address);
  prefer(weak.port, strong.port);
  prefer(weak.unit, strong.unit);
  prefer(weak.framing, strong.framing);
  prefer(weak.serial, strong.serial);
  prefer(weak.baud, strong.baud);
  prefer(weak.parity, strong.parity);
  prefer(weak.stop_bits, strong.stop_bits);
  prefer(weak.rs485, strong.rs485);
  prefer(weak.certificate, strong.certificate);
  prefer(weak.key, strong.key);
  prefer(weak.ca, strong.ca);
  prefer(weak.tls_name, strong.tls_name);
  prefer(weak.pin, strong.pin);
  prefer(weak.rate, strong.rate);
  prefer(weak.timeout, strong.timeout);
  prefer(weak.record, strong.record);
  prefer(weak.panel, strong.panel);
  prefer(weak.verify, strong.verify);
  prefer(weak.poll, strong.poll);
  return weak;
}

Settings with_map(Settings settings, const Map& map) {
  settings.name = std::string(map.name);
  const auto& [address, port, unit, timeout, framing, serial, tls] = map.connection;
  settings.address = std::string(address);
  settings.port = port;
  settings.unit = unit;
  settings.framing = framing;
  settings.serial = std::string(serial.device);
  settings.baud = serial.baud;
  settings.parity = serial.parity;
  settings.stop_bits = serial.stop_bits;
  settings.rs485 = serial.rs485;
  settings.certificate = std::string(tls.certificate);
  settings.key = std::string(tls.key);
  settings.ca = std::string(tls.ca);
  settings.tls_name = std::string(tls.name);
  settings.pin = std::string(tls.pin);
  settings.timeout = timeout;
  settings.rate = map.polling.rate;
  settings.verify = map.verify;
  settings.poll = map.poll;
  return settings;
}

void apply(const Settings& settings, Map& map) {
  if (settings.name) map.name = *settings.name;
  Connection& connection = map.connection;
  const bool was_rtu = connection.is_rtu();
  const bool had_tls = connection.tls.present();
  if (settings.address) {
    connection.address = *settings.address;
    connection.framing = Framing::tcp;
    connection.serial.device = {};
  }
  if (settings.port) connection.port = *settings.port;
  if (settings.unit) connection.unit = *settings.unit;
  if (settings.framing) connection.framing = *settings.framing;
  if (settings.serial) {
    connection.serial.device = *settings.serial;
    connection.address = {};
  }
  if (settings.baud) connection.serial.baud = *settings.baud;
  if (settings.parity) connection.serial.parity = *settings.parity;
  if (settings.stop_bits) connection.serial.stop_bits = *settings.stop_bits;
  if (settings.rs485) connection.serial.rs485 = *settings.rs485;
  apply(settings, connection.tls);
  if (settings.serial) connection.tls = {};
  if (!had_tls && connection.tls.present() && !settings.port && connection.port == modbus::default_port)
    connection.port = default_tls_port;
  connection.changed_from(was_rtu);
  if (settings.timeout) connection.timeout = *settings.timeout;
  if (settings.rate) map.polling.rate = *settings.rate;
  if (settings.poll) map.poll = *settings.poll;
  if (settings.verify) map.verify = *settings.verify;
}

}  // namespace coupler::host
