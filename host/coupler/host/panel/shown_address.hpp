// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::host {

/// What browsers on other machines write for the address at which this one listens: one of its own, if that
/// is all of them.
std::string shown_address(const std::string& listen);

}  // namespace coupler::host
