// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/host/core/error.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// Shows at most sixteen bytes, as in "03 04 00 14".
std::string shown_bytes(modbus::Bytes bytes);

/// Makes an error that shows the request and the reply: `asked` and `came` are two PDUs, or two ADUs.
BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came);

}  // namespace coupler::host
