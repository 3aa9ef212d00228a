// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/docs/document.hpp"

namespace coupler::docs {

/// The register map as one HTML page that needs no other file and no network, and is complete without
/// scripts: those only search and sort.
std::string html_page(const Document& document);

}  // namespace coupler::docs
