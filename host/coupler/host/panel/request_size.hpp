// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace coupler::host {

constexpr std::size_t unknown_size = std::string_view::npos;

/// Bytes of the request that begins with these: its header, and the body that this announces (RFC 9112 6.3).
/// What the server refuses is not counted: a body of more than `largest` bytes, or one in chunks.
/// unknown_size: the header has not ended. `from`: it has not ended in so many bytes at the begin.
std::size_t request_size(std::string_view text, std::size_t from, std::size_t largest);

}  // namespace coupler::host
