// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/plan/planner.hpp"

namespace coupler::plan {

struct PictureOptions {
  bool every_table = false;  ///< those without points too
  std::string_view link{};   ///< "#point-": each point links to this and its name; empty: no links
};

/// The address spaces as an SVG image that needs nothing else: points, the requests that read them, the holes
/// that are read with them, what is unreadable. It can stand alone as a file or inside an HTML page. Tables
/// without points are left out, as are stretches of addresses that nothing happens in. Small maps show names;
/// in every one a tooltip tells of a point or a request.
std::string picture(const Map& map, const std::vector<GroupPlan>& plan, const PictureOptions& options = {});

}  // namespace coupler::plan
