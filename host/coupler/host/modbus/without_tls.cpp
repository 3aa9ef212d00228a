// SPDX-License-Identifier: Apache-2.0
// In a build without OpenSSL.
#include "coupler/host/modbus/tls_link.hpp"

namespace coupler::host {

Result<std::unique_ptr<TlsLink>> open_tls(Descriptor, const std::string&, const TlsTexts&, const Deadline&,
                                          const Event&) {
  return fail(NotConnected{"this build has no TLS; build it with OpenSSL 3 (apt install libssl-dev)", true});
}

}  // namespace coupler::host
