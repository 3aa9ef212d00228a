// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::cli {

/// What the files say that `security:` and `tls:` of a map name. A map is often checked elsewhere than where
/// it is used: files that this user cannot read are none of its errors.
struct CertificateFindings {
  std::vector<std::string> lines;     ///< for people: until when they are good, or why nothing is known
  std::vector<std::string> problems;  ///< why node or driver would not begin with them, and what to do
};

CertificateFindings check_certificates(const Map& map);

}  // namespace coupler::cli
