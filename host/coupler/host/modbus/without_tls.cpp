// SPDX-License-Identifier: Apache-2.0
// In a build without OpenSSL.
#include "coupler/host/modbus/tls_socket.hpp"

namespace coupler::host {

Result<std::unique_ptr<TlsSocket>> open_tls(int, const std::string&, const TlsTexts&, const Deadline&,
                                            const Event&) {
  return fail(NotConnected{"this build has no TLS; build it with OpenSSL 3 (apt install libssl-dev)", true});
}

}  // namespace coupler::host
