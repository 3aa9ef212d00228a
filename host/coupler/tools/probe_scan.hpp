// SPDX-License-Identifier: Apache-2.0
// The scan of `coupler probe`, for whoever needs one.
#pragma once

#include "coupler/host/core/error.hpp"
#include "coupler/host/scan/scan.hpp"
#include "coupler/tools/probe_call.hpp"

namespace coupler::tools {

/// Scans with each of `call.lines` in turn, until a unit answers. call.connection then has the settings with
/// which it answered. Shows the progress on standard error. An ending signal (see Interruption) ends the
/// scan, and is call.ended_by.
scan::Findings look_at_each_line(ProbeCall& call);

/// Why a device cannot be reached, and what to do.
Failure why_unreachable(const host::Error& error, const Connection& connection);

/// Why no unit was found by a scan that came to its end, and what to do.
Failure why_no_unit(const ProbeCall& call);

}  // namespace coupler::tools
