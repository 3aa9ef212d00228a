// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <XmlRpcValue.h>

namespace coupler::host {

/// The arguments of a call to the master or to a node, which begin with who calls.
XmlRpc::XmlRpcValue own_name();

/// Empty: the master does not know the node, or does not answer, unless it is waited for.
std::string uri_of(const std::string& node, bool wait_for_master = false);

}  // namespace coupler::host
