// SPDX-License-Identifier: Apache-2.0
// In a build without OpenSSL.
#include "coupler/host/panel/page_tls.hpp"
#include "coupler/host/panel/panel_server.hpp"

namespace coupler::host {

tl::expected<std::shared_ptr<const PageTls>, std::string> read_page_tls(const std::string&,
                                                                        const std::string&) {
  return tl::unexpected(
      std::string("this build has no TLS; build it with OpenSSL 3 (apt install libssl-dev)"));
}

}  // namespace coupler::host
