// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::fakes {

/// How often this program took memory from the heap by `new`. Linking this replaces operator new.
long allocations();

}  // namespace coupler::fakes
