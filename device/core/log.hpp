// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

namespace coupler::node {

/// Takes one line for the node's log, without a newline.
using Log = std::function<void(std::string_view)>;

}  // namespace coupler::node
