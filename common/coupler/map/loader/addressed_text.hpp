// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"

namespace coupler::loader {

/// The text of a map, with the addresses written into it that its points got from the lock: the same map for
/// one who has no lock.
std::string addressed_text(std::string_view text, const DraftPoints& points, Addressing addressing);

}  // namespace coupler::loader
