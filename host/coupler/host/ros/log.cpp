// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/log.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler::host {

void print(std::string_view text) { fmt::print(stderr, "coupler_driver: {}\n", printable_lines(text)); }

}  // namespace coupler::host
