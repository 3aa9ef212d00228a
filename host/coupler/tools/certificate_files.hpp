// SPDX-License-Identifier: Apache-2.0
// The folders and files of `coupler certificates`: a call that is killed leaves none that is half written,
// and nothing that stands in the way of the next. Errors are one line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

struct NewFile {
  std::filesystem::path path;
  std::string text;
  bool is_secret;  ///< only its owner can read it
};
/// Writes files to a folder of make_folder(), and then puts them, in this order, in place of those that have
/// their names. Returns an error if one of them cannot be written; all are as they were then. One that cannot
/// be put in its place, as where a folder has its name, leaves those before it in theirs.
tl::expected<void, std::string> replace(const std::vector<NewFile>& files);

/// NAME, NAME-2, NAME-3 …: each request (--csr) has a number, as renewed certificates once had. The newest
/// that has a file with this ending, and the first one that has no file.
struct Stems {
  std::optional<std::string> newest;
  std::string next;
};
Stems stems_in(const std::filesystem::path& folder, const std::string& name, const char* ending);

/// Copies STEM.pem, whose text is `certificate`, and STEM.key to names with the date of the certificate's
/// end, unless a call that was killed has done so. Returns what these names begin with.
tl::expected<std::string, std::string> keep_former(const std::filesystem::path& folder,
                                                   const std::string& stem, const std::string& certificate);

}  // namespace coupler::tools
