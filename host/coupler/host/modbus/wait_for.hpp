// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/transport.hpp"
#include "coupler/host/modbus/event.hpp"
#include "coupler/host/modbus/wakeup.hpp"

namespace coupler::host {

/// Transport::wait_until() on real descriptors. `socket` may be -1: none.
Transport::Woken wait_for(Wakeup& wakeup, const Event& interrupted, int socket, Time time);

}  // namespace coupler::host
