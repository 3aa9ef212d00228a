// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace coupler::generate {

enum class Outcome { unchanged, written };

/// Makes the file hold exactly `content`. A file that already does is not touched, so that a build does
/// nothing more; otherwise it is replaced in one step: nobody ever reads half of it. Where `path` is a
/// symbolic link, that holds for what it leads to, and the link stays. A file keeps its permissions; a pipe
/// or a device is written to. The folder must exist. The error says which file and why.
tl::expected<Outcome, std::string> write_if_changed(const std::filesystem::path& path,
                                                    std::string_view content);

}  // namespace coupler::generate
