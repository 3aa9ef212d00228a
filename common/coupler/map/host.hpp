// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace coupler {

struct HostError {
  std::string what;  ///< "has a port", to follow the text
  std::string remedy;
};

/// A host name (RFC 1123, and '_') or an IP address, as a map's `address` is. The result is a part of the
/// text: without the brackets that an IPv6 address may have.
tl::expected<std::string_view, HostError> parse_host(std::string_view text);

}  // namespace coupler
