// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// Returns the text of a request for a log, as "read holding_registers 4 to 9".
std::string request_text(modbus::Bytes pdu);

}  // namespace coupler::host
