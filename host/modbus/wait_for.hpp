// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/core/transport.hpp"
#include "host/modbus/event.hpp"
#include "host/modbus/wakeup.hpp"

namespace coupler::driver {

/// Transport::wait_until() on real descriptors. `socket` may be -1: none.
Transport::Woken wait_for(Wakeup& wakeup, const Event& interrupted, int socket, Time time);

}  // namespace coupler::driver
