// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/importer.hpp"

namespace coupler::formats {

/// ModbusPal's projects (.xmpp): the coils and holding registers of its slaves. Registers are UINT; those
/// that an automation feeds as SINT16, SINT32 or FLOAT32 are INT, DINT or REAL. Neither the DTD nor any other
/// entity is ever looked at.
std::vector<ForeignUnit> read_modbuspal(std::string_view text, loader::Problems& problems);

}  // namespace coupler::formats
