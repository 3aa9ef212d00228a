// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::host {

/// `~/get_type_description`, where rcl has it. It is offered as long as what is returned.
std::shared_ptr<void> offer_type_descriptions(rcl::Node& node);

}  // namespace coupler::host
