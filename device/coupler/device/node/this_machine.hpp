// SPDX-License-Identifier: Apache-2.0
// Which machine this is, as the node reports it: it distinguishes two boards with one map.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "coupler/map/identity.hpp"

namespace coupler::device {

/// Returns what tells this machine from others, the first of these that exists: the board's serial number
/// (device tree, DMI), the permanent MAC address of its first network interface, its machine-id. It is empty
/// if there is none. Files that a service may not read do not exist for it. `root` is where / is.
std::string find_serial(const std::string& root = {});

/// Returns what is shown of a serial; 0 if the serial is empty. A machine-id is a secret (machine-id(5)): the
/// prefix keeps its hash from being compared with what other programs derive from it.
std::uint64_t hashed_serial(std::string_view serial);

/// Its hostname, with ? for what is not printable ASCII, and its hashed serial. It reads a few small files,
/// and cannot fail.
identity::Machine this_machine(const std::string& root = {});

}  // namespace coupler::device
