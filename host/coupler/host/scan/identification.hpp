// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "coupler/host/scan/prober.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::scan {

/// Requests one reply; nullopt: there is none.
using AskIdentification = std::function<std::optional<IdentificationPage>(modbus::ReadDeviceIdentification)>;

/// The objects of FC 43/14 by id, basic, regular and extended, as the device has them: any bytes. Empty if
/// the device has none.
std::map<std::uint8_t, std::string> read_identification(const AskIdentification& ask);
std::map<std::uint8_t, std::string> read_identification(Prober& prober);

/// "VendorName" … for those that MAP 6.21 names, "object 80" for others.
std::string object_name(std::uint8_t id);

/// The identity of a node of this project; nullopt: a foreign device.
std::optional<identity::Head> read_node_identity(Prober& prober);

}  // namespace coupler::scan
