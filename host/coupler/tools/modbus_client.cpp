// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/modbus_client.hpp"

#include <array>

#include <fmt/format.h>

#include "coupler/host/core/identity_check.hpp"
#include "coupler/modbus/device_identification.hpp"

namespace coupler::tools {

std::string reach_remedy(const Connection& where, const host::Error& error, std::string_view over_tcp) {
  if (where.is_rtu() && std::holds_alternative<host::Timeout>(error)) return host::line_remedy(where);
  if (std::holds_alternative<host::Timeout>(error))
    return fmt::format(
        "the connection was accepted, but unit {} does not answer; {}: a node answers to its own, 0 and 255, "
        "a gateway to those of the units behind it",
        where.unit, host::silent_unit_remedy);
  return where.serial.present() || has_remedy(error) ? std::string() : std::string(over_tcp);
}

host::Result<scan::IdentificationPage> read_identification(host::Link& link,
                                                           modbus::ReadDeviceIdentification wanted) {
  const auto pdu = modbus::build_device_identification(wanted);
  const auto reply = link.exchange(pdu);
  if (!reply) return tl::make_unexpected(reply.error());
  std::array<modbus::IdentificationObject, modbus::max_identification_objects> objects{};
  const auto taken = modbus::take_device_identification(*reply, objects);
  if (!taken) return host::fail(host::BadFrame{"no device identification"});
  scan::IdentificationPage page;
  for (std::size_t i = 0; i < taken->count; ++i)
    page.objects.emplace(objects[i].id, std::string(objects[i].value));
  if (taken->more) page.next = taken->next;
  return page;
}

}  // namespace coupler::tools
