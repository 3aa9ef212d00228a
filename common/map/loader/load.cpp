// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/load.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "common/map/loader/document.hpp"
#include "common/map/loader/map_reader.hpp"

namespace coupler {
namespace {

std::string read_all(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

LoadResult unreadable(const std::string& path, int error) {
  return {nullptr,
          {{Diagnostic::Severity::error, path, 0, 0,
            std::string("the file cannot be read: ") + std::strerror(error), "give the path of a map"}}};
}

}  // namespace

LoadResult load_map(std::string_view text, std::string_view file) {
  loader::Problems problems(file);
  const auto map = std::make_shared<OwnedMap>();
  loader::Context context{problems, *map};
  if (const auto root = loader::parse_document(text, problems)) loader::read_map(*root, text, context);
  const bool failed = problems.has_errors();
  return {failed ? nullptr : map, std::move(problems).sorted()};
}

LoadResult load_map_file(const std::string& path) {
  if (path == "-") return load_map(read_all(std::cin), "<stdin>");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return unreadable(path, errno);
  std::string text;
  try {
    text = read_all(in);
  } catch (const std::exception&) {  // a folder: libstdc++'s buffer throws on a failed read
    return unreadable(path, EISDIR);
  }
  return load_map(text, path);
}

}  // namespace coupler
