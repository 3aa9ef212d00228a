// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/docs/document.hpp"

namespace coupler::docs {

/// The points as one HTML table, sorted as the map's are.
std::string html_rows(const Document& document);

}  // namespace coupler::docs
