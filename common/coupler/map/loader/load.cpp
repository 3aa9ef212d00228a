// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/load.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/map/lock/lock.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler {
namespace {

/// EFBIG: it has more than max_file_size bytes; not all of them were read.
tl::expected<std::string, int> read_all(std::istream& in) {
  std::string text;
  std::array<char, 65536> piece{};
  do {
    in.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > max_file_size) return tl::make_unexpected(EFBIG);
  } while (in);
  return text;
}

/// The text, or the system's error number.
tl::expected<std::string, int> read_file(const std::string& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return tl::make_unexpected(errno);
  auto text = read_all(in);
  if (in.bad()) return tl::make_unexpected(EISDIR);  // or another failed read, whose number is lost
  return text;
}

LoadResult no_map(const std::string& path, std::string what, std::string remedy) {
  return {nullptr, {{Diagnostic::Severity::error, path, 0, 0, std::move(what), std::move(remedy)}}};
}

LoadResult unreadable(const std::string& path, int error, std::string remedy) {
  return no_map(path,
                error == EFBIG
                    ? fmt::format("the file has more than {} MiB, but a map may not", max_file_size >> 20)
                    : fmt::format("the file cannot be read: {}", std::strerror(error)),
                std::move(remedy));
}

/// The text with the addresses, which a node serves, is the same map. It is read again to make sure:
/// addresses cannot be written into every text.
void check_filled_in(const Map& map, loader::Position first, loader::Problems& problems) {
  const LoadResult served = load_map_with_lock(map.text, "", LockFile{}, map.name);
  if (served.map != nullptr && served.map->map().fingerprint == map.fingerprint) return;
  const auto error =
      std::find_if(served.diagnostics.begin(), served.diagnostics.end(),
                   [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
  problems.error(first,
                 fmt::format("the addresses that the map leaves out cannot be filled in ({})",
                             error == served.diagnostics.end() ? "it would be another map" : error->what),
                 "write them into the map");
}

LoadResult load(std::string_view file, LockFile lock, const loader::MapSource& source) {
  const std::string_view text = source.text;
  lock::Parsed known;
  const std::string lock_text = lock.text.value_or("");
  if (lock.text) known = lock::parse(*lock.text, lock.path);
  // The map's own problems are reported too; which addresses points get beside a broken lock does not matter.
  if (!known.diagnostics.empty()) lock.use = LockUse::renew;
  loader::Placement placement{std::string(file), std::move(lock), std::move(known.lock), {}, {}};
  placement.problems = std::move(known.diagnostics);

  loader::Problems problems(file);
  const auto map = OwnedMap::make();
  std::optional<loader::MapLayout> layout;
  if (const auto root = loader::parse_document(text, problems))
    layout = loader::read_map(*root, source, placement, problems, *map);
  if (layout && layout->first_addressless.line > 0)
    check_filled_in(map->map(), layout->first_addressless, problems);
  LoadResult result{nullptr, std::move(placement.problems)};
  quote(result.diagnostics, lock_text);
  if (!problems.has_errors() && !has_errors(result.diagnostics)) {
    result.map = map;
    result.point_lines = std::move(layout->point_lines);
    result.lock = std::move(placement.renewed);
  }
  Diagnostics of_map = std::move(problems).sorted();
  quote(of_map, loader::without_byte_order_mark(text));
  for (Diagnostic& diagnostic : of_map) result.diagnostics.push_back(std::move(diagnostic));
  return result;
}

}  // namespace

std::string near_file(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr std::size_t most_files = 1000;
  const std::array<std::string_view, 3> endings{".yaml", ".yml", ".json"};
  const fs::path missing(path);
  const fs::path folder = missing.parent_path();
  std::error_code error;
  fs::directory_iterator each(folder.empty() ? fs::path(".") : folder, error);
  std::vector<std::string> names;
  for (; !error && each != fs::directory_iterator() && names.size() < most_files; each.increment(error)) {
    const fs::path name = each->path().filename();
    std::error_code ignored;
    if (std::find(endings.begin(), endings.end(), name.extension().string()) == endings.end() ||
        !each->is_regular_file(ignored))
      continue;
    if (name.stem() == missing.filename() || name.stem() == missing.stem())
      return fmt::format("did you mean {}?", (folder / name).string());
    names.push_back(name.string());
  }
  const std::string_view near =
      nearest(missing.filename().string(), std::vector<std::string_view>(names.begin(), names.end()));
  return near.empty() ? std::string() : fmt::format("did you mean {}?", (folder / near).string());
}

LoadResult load_map(std::string_view text, std::string_view file) { return load(file, LockFile{}, {text}); }

LoadResult load_served_map(std::string_view text, std::string_view file) {
  return load(file, LockFile{}, {text, {}, true});
}

LoadResult load_map_with_lock(std::string_view text, std::string_view file, LockFile lock,
                              std::string_view name) {
  return load(file, std::move(lock), {text, name});
}

LoadResult load_map_file(const std::string& path, LockUse use, std::string_view name) {
  if (path == "-") {
    const auto text = read_all(std::cin);
    if (!text) return unreadable("<stdin>", text.error(), "give it a map");
    return load_map_with_lock(*text, "<stdin>", LockFile{}, name);
  }
  std::error_code ignored;
  if (std::filesystem::is_character_file(path, ignored))  // a serial line has no end
    return no_map(path, "it is a device, not a file", "give the path of a map, or - for standard input");
  const auto text = read_file(path);
  if (!text) {
    const std::string near = text.error() == ENOENT ? near_file(path) : std::string();
    return unreadable(path, text.error(), near.empty() ? "give the path of a map" : near);
  }
  LockFile lock{path + ".lock", std::nullopt, use};
  auto lock_text = read_file(lock.path);
  if (!lock_text && lock_text.error() != ENOENT)
    return unreadable(lock.path, lock_text.error(),
                      "it is the lock of the map: make it a file that can be read");
  if (lock_text) lock.text = std::move(*lock_text);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return load(path, std::move(lock), {*text, name, false, folder});
}

}  // namespace coupler
