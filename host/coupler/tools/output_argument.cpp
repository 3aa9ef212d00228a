// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/output_argument.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "coupler/generate/output.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::tools {
namespace {

Exit write_file(std::string_view command, std::string_view option, const std::string& file,
                const std::string& text) {
  if (const auto outcome = generate::write_if_changed(file, text); !outcome)
    return complain(command, bad_call, outcome.error(),
                    fmt::format("give a file that you may write with {}", option));
  return ok;
}

}  // namespace

tl::expected<void, Failure> can_make(const std::string& out, bool force) {
  if (names_no_file(out)) return {};
  const std::filesystem::path path(out);
  std::error_code ignored;
  if (!force && std::filesystem::exists(path, ignored))
    return fail(bad_call, out + " already exists",
                "name another file with --out, or replace it with --force");
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), ignored))
    return fail(bad_call, path.parent_path().string() + " is not a folder",
                "create it, or name another one with --out");
  return {};
}

Exit write_out(std::string_view command, const std::string& out, const std::string& text) {
  if (!names_no_file(out)) return write_file(command, "--out", out, text);
  put(::isatty(STDOUT_FILENO) == 1 ? printable_lines(text) : text);
  return ok;
}

Exit write_beside_map(std::string_view command, const std::string& map, std::string_view option,
                      const std::string& file, const std::string& text) {
  std::error_code not_a_file;  // a device has none, and what is new is none yet
  if (std::filesystem::equivalent(map, file, not_a_file))
    return complain(command, bad_call, fmt::format("{} is the map itself", file),
                    fmt::format("name another file with {}", option));
  return write_file(command, option, file, text);
}

bool has_none_of(const std::string& file, std::initializer_list<std::string_view> marks) {
  std::error_code not_a_file;
  if (!std::filesystem::is_regular_file(file, not_a_file)) return false;
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto is_in = [&](std::string_view mark) { return text.find(mark) != std::string::npos; };
  return !text.empty() && std::none_of(marks.begin(), marks.end(), is_in);
}

}  // namespace coupler::tools
