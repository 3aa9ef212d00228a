// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/host/core/error.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// "03 04 00 14 …": sixteen of them at most.
std::string shown_bytes(modbus::Bytes bytes);

/// BadFrame that says what was asked and what came, from the function code on or both as a whole.
BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came);

}  // namespace coupler::host
