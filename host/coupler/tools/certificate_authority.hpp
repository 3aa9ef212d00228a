// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/tls/issue.hpp"

namespace coupler::tools {

/// Returns the authority in DIR/authority, and makes it if it is not there. Returns an error if one of the
/// subjects has a certificate of another authority.
tl::expected<tls::Pem, std::string> authority_in(const std::filesystem::path& folder, tls::KeyKind kind,
                                                 const std::vector<tls::Subject>& subjects);

}  // namespace coupler::tools
