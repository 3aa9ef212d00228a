// SPDX-License-Identifier: Apache-2.0
// What rcl has in some distributions only. Tried: Jazzy and Kilted. Humble's rcl (5) has no version.h.
#pragma once

#if __has_include(<rcl/version.h>)
#include <rcl/version.h>
#endif

// An event when a subscription comes or goes, and ~/get_type_description: from Iron (6) on.
#if defined(RCL_VERSION_MAJOR) && RCL_VERSION_MAJOR >= 6
#define COUPLER_RCL_HAS_MATCHED_EVENTS 1
#define COUPLER_RCL_HAS_TYPE_DESCRIPTIONS 1
#else
#define COUPLER_RCL_HAS_MATCHED_EVENTS 0
#define COUPLER_RCL_HAS_TYPE_DESCRIPTIONS 0
#endif

// rcl_node_init() publishes /rosout by itself up to Iron (6); from Jazzy on who makes the node does
// (ros2/rcl#1065).
#if defined(RCL_VERSION_MAJOR) && RCL_VERSION_MAJOR >= 7
#define COUPLER_RCL_LEAVES_ROSOUT_TO_US 1
#else
#define COUPLER_RCL_LEAVES_ROSOUT_TO_US 0
#endif
