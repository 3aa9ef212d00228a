// SPDX-License-Identifier: Apache-2.0
// In place of serial_port.cpp where COUPLER_SERIAL is OFF.
#include <string>

#include "coupler/host/modbus/serial_port.hpp"

namespace coupler::host {

Result<SerialPort> SerialPort::open(const Serial& settings) {
  return fail(NotConnected{std::string(settings.device) +
                           ": this program was built without serial lines; build it with "
                           "-DCOUPLER_SERIAL=ON, or use a gateway to TCP"});
}

int SerialPort::fd() const { return -1; }

}  // namespace coupler::host
