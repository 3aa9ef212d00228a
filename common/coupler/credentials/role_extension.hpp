// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <tl/expected.hpp>

#include "coupler/base/span.hpp"

namespace coupler {

/// The object identifier of the extension that holds a client's role (MBTPS 8.3).
constexpr const char* role_extension_id = "1.3.6.1.4.1.50316.802.1";

/// The role in the value of that extension: one DER UTF8String that fills it, 1 to longest_role_name bytes,
/// without control characters. It points into `extension`. The error says what is wrong.
tl::expected<std::string_view, std::string_view> parse_role(Span<const std::uint8_t> extension);

}  // namespace coupler
