// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::host::test {

/// Lets one allocation by `new` fail in this thread: the next one, or the one after so many more. Linking
/// this replaces operator new.
void fail_allocation(long after = 0);
/// Returns whether it has failed. If not, none fails any more.
bool has_failed();

}  // namespace coupler::host::test
