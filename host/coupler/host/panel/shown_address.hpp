// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::host {

/// Returns the address that browsers on other machines need for the one at which this machine listens: one of
/// its own, if it listens at all of them.
std::string shown_address(const std::string& listen);

}  // namespace coupler::host
