// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/docs/document.hpp"

namespace coupler::docs {

/// The register map as GitHub-flavoured Markdown: a table for each address space.
std::string markdown_page(const Document& document);

}  // namespace coupler::docs
