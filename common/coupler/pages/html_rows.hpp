// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/pages/document.hpp"

namespace coupler::pages {

/// The points as one HTML table, sorted as the map's are.
std::string html_rows(const Document& document);

}  // namespace coupler::pages
