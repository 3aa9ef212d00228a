// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/pages/document.hpp"

namespace coupler::pages {

/// The register map as GitHub-flavoured Markdown: a table for each address space.
std::string markdown_page(const Document& document);

}  // namespace coupler::pages
