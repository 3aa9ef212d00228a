// SPDX-License-Identifier: Apache-2.0
// What libgpiod 1 and libgpiod 2 do differently. CMake chooses one: coupler/device/gpio/libgpiod1 or
// libgpiod2.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/gpio/inventory.hpp"
#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device::backend {

/// The chips of this machine.
Inventory chips();

/// How many lines are watched though no counter, latched point or debounce needs it; each costs descriptors.
std::size_t max_watched();

/// Returns whether the kernel takes `line` into the same request as these, of which there is at least one.
/// Inputs and outputs are never mixed, nor are watched inputs and other inputs.
bool fits(const std::vector<LineSpec>& group, const LineSpec& line);

/// One to max_group_size lines that fit together. Outputs begin at their wanted levels, with no other
/// level in between. The error names chip, line and holder.
tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines);

/// The same for inputs. Those that are watched are told of with each change, by their edges; of the others
/// only the levels can be read.
tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines);

}  // namespace coupler::device::backend
