// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::tools {

/// The findings in the files that `security:` and `tls:` of a map name. A map is often checked on another
/// machine than the one that uses it, so files that this user cannot read are not errors of the map.
struct CertificateFindings {
  std::vector<std::string> lines;     ///< for people: until when they are good, or why nothing is known
  std::vector<std::string> problems;  ///< why node or driver would not begin with them, and what to do
};

CertificateFindings check_certificates(const Map& map);

}  // namespace coupler::tools
