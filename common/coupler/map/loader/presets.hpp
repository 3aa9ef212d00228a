// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coupler/base/span.hpp"

namespace coupler::loader {

/// A file of config/presets, built in.
struct PresetFile {
  std::string_view name;
  std::string_view text;
};
Span<const PresetFile> preset_files();

}  // namespace coupler::loader
