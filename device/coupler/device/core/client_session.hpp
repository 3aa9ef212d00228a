// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::device {

/// What the node remembers of a connection: one for each, made anew when it is opened.
struct ClientSession {
  bool has_written = false;  ///< a write of it to an output was carried out
};

}  // namespace coupler::device
