// SPDX-License-Identifier: Apache-2.0
// The folders and files of `coupler certificates`: a call that is killed leaves none that is half written,
// and nothing that stands in the way of the next. Errors are one line.
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

namespace coupler::tools {

/// Makes the folder if it does not exist, and deletes what a killed call left unfinished in it. Only its
/// owner can use a secret folder.
tl::expected<void, std::string> make_folder(const std::filesystem::path& folder, bool is_secret);

/// Locks the folder until the program ends, because two calls at once would mix their files. Returns an error
/// if another call has locked it.
tl::expected<void, std::string> lock_folder(const std::filesystem::path& folder);

/// Writes a new file to a folder of make_folder(), whole or not at all. Only its owner can read a secret
/// file.
tl::expected<void, std::string> write_new(const std::filesystem::path& path, const std::string& text,
                                          bool is_secret);

}  // namespace coupler::tools
