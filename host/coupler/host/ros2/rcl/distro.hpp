// SPDX-License-Identifier: Apache-2.0
// What rcl has in some distributions only. Tried: Jazzy and Kilted. Humble's rcl (5) has no version.h.
#pragma once

#if __has_include(<rcl/version.h>)
#include <rcl/version.h>
#endif

// RCL_VERSION_MAJOR is 0 in #if where it is not defined.

// An event when a subscription comes or goes, and ~/get_type_description: from Iron (6) on.
#define COUPLER_RCL_HAS_MATCHED_EVENTS (RCL_VERSION_MAJOR >= 6)
#define COUPLER_RCL_HAS_TYPE_DESCRIPTIONS (RCL_VERSION_MAJOR >= 6)

// rcl_node_init() publishes /rosout by itself up to Iron (6); from Jazzy on who makes the node does
// (ros2/rcl#1065).
#define COUPLER_RCL_LEAVES_ROSOUT_TO_US (RCL_VERSION_MAJOR >= 7)
