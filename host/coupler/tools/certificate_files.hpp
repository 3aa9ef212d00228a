// SPDX-License-Identifier: Apache-2.0
// The folders and files of `coupler certificates`: a call that is killed leaves none that is half written,
// and nothing that stands in the way of the next. Errors are one line.
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

namespace coupler::tools {

/// The folder is there then, a secret one for its owner only; what a killed call left unfinished in it is
/// not.
tl::expected<void, std::string> make_folder(const std::filesystem::path& folder, bool is_secret);

/// Two calls at once would mix their files: the second one gets an error. Held until the program ends.
tl::expected<void, std::string> lock_folder(const std::filesystem::path& folder);

/// A new file in a folder of make_folder(), whole or not at all; a key can be read by its owner only.
tl::expected<void, std::string> write_new(const std::filesystem::path& path, const std::string& text,
                                          bool is_secret);

}  // namespace coupler::tools
