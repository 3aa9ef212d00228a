// SPDX-License-Identifier: Apache-2.0
// Building the loader's tree.
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"

namespace coupler::formats {

/// `quoted`: a text, even if it looks like a number.
loader::Entry scalar(std::string_view key, std::string text, loader::Position at, bool quoted = false);

loader::Entry section(std::string_view key, loader::Position at);

/// The first child of that key, or nullptr.
const loader::Entry* find(const loader::Entry& parent, std::string_view key);
loader::Entry* find(loader::Entry& parent, std::string_view key);

/// The section of that key, added at the end if it is not there.
loader::Entry& make_section(loader::Entry& parent, std::string_view key, loader::Position at);

/// In place of the child with the same key, or at the end.
void set(loader::Entry& parent, loader::Entry child);

}  // namespace coupler::formats
