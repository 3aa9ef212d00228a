// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coupler/host/core/link.hpp"

namespace coupler::host::test {

/// Returns what a link to a channel of a test needs.
inline std::shared_ptr<SharedChannel> share(Channel& channel) {
  return std::make_shared<SharedChannel>(std::shared_ptr<Channel>(std::shared_ptr<Channel>(), &channel));
}

}  // namespace coupler::host::test
