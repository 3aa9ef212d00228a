// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/map_argument.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/base/starts_with.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/map/network.hpp"
#include "coupler/tools/live_map.hpp"

namespace coupler::tools {
namespace {

MapArgument no_map(const std::string& argument, const Failure& why) {
  MapArgument none;
  none.exit = why.exit;
  none.loaded.diagnostics.push_back({Diagnostic::Severity::error, argument, 0, 0, why.what, why.remedy});
  return none;
}

tl::expected<FoundMap, Failure> served_map(const Place& place) {
  auto map = fetch_live_map(place.connection);
  if (!map) return tl::make_unexpected(std::move(map.error()));
  return FoundMap{*std::move(map), place.connection};
}

/// Returns the failure of an argument that is neither a file nor a device that can be reached. An address
/// cannot be meant as a file.
Failure neither(const std::string& argument, Failure why) {
  const std::string place = node_argument(argument);
  const auto node = parse_node_address(place);
  const bool is_address = node && (node->serial.present() || is_ip_address(node->host));
  if (names_a_node(argument) || is_address || why.exit == bad_input) return why;
  const std::string near = near_file(argument);
  return {why.exit, "no such file, and as a device: " + why.what,
          (why.remedy.empty() ? "" : why.remedy + "; ") + "or give the path of a map" +
              (near.empty() ? "" : "; " + near)};
}

MapArgument from_device(const std::string& argument, const TlsTexts& tls, const FindMap& find) {
  const auto place = get_place(argument, tls);
  if (!place) return no_map(argument, neither(argument, place.error()));
  auto map = find(*place);
  if (!map) return no_map(argument, neither(argument, map.error()));
  MapArgument found{{}, ok, place->node, place->connection.tls, place->text};
  found.loaded.map = std::move(map->map);
  found.node->unit = map->where.unit;
  found.node->serial = map->where.serial;
  return found;
}

LoadResult load_and_renew_lock(const std::string& path) {
  LoadResult loaded = load_map_file(path, LockUse::renew);
  if (!loaded.map || loaded.lock.text.empty()) return loaded;
  const auto written = generate::write_if_changed(loaded.lock.path, loaded.lock.text);
  if (written) return loaded;
  loaded.diagnostics.push_back(
      {Diagnostic::Severity::error, loaded.lock.path, 0, 0, written.error(),
       "new points get addresses only if the lock can keep them: work in a folder that you may write to"});
  return {nullptr, std::move(loaded.diagnostics)};
}

MapArgument from_file(LoadResult loaded) {
  const Exit exit = loaded.map ? ok : bad_input;
  return {std::move(loaded), exit};
}

constexpr int could_not_run = 127;  ///< what posix_spawn()'s child, like a shell, ends with

/// A file without a name, and not a pipe: git may write more than a pipe holds before it is read.
class Scratch {
 public:
  Scratch() : file_(std::tmpfile()) {}
  ~Scratch() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  bool is_open() const { return file_ != nullptr; }
  int descriptor() const { return ::fileno(file_); }
  std::string content() const {
    std::string text;
    std::array<char, 4096> piece{};
    if (std::fseek(file_, 0, SEEK_SET) != 0) return text;
    while (std::feof(file_) == 0 && std::ferror(file_) == 0)
      text.append(piece.data(), std::fread(piece.data(), 1, piece.size(), file_));
    return text;
  }

 private:
  std::FILE* file_;
};

int run_git_show(const std::string& object, const Scratch& out, const Scratch& error) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error.descriptor(), STDERR_FILENO);
  // --end-of-options: an argument that begins with a dash is no option of git.
  std::array<std::string, 4> words{"git", "show", "--end-of-options", object};
  std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  pid_t git = 0;
  const int error_number = ::posix_spawnp(&git, "git", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error_number != 0) return could_not_run;
  int status = 0;
  while (::waitpid(git, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : could_not_run;
}

/// The content, or what git says.
tl::expected<std::string, std::string> git_show(const std::string& object) {
  const Scratch out;
  const Scratch error;
  if (!out.is_open() || !error.is_open())
    return tl::unexpected<std::string>(fmt::format("no temporary file: {}", std::strerror(errno)));
  const int status = run_git_show(object, out, error);
  if (status == 0) return out.content();
  if (status == could_not_run) return tl::unexpected<std::string>("git could not be run");
  std::string said = error.content();
  said = said.substr(0, said.find('\n'));
  return tl::unexpected<std::string>(starts_with(said, "fatal: ") ? said.substr(7) : said);
}

/// REVISION:PATH, and neither a file of that name nor HOST:PORT.
bool names_a_revision(const std::string& argument) {
  const auto colon = argument.find(':');
  std::error_code ignored;
  return colon != std::string::npos && colon != 0 && colon + 1 < argument.size() && !names_a_node(argument) &&
         !parse_node_address(node_argument(argument)) && !std::filesystem::exists(argument, ignored);
}

/// The lock is that of the same revision.
LoadResult load_revision(const std::string& argument) {
  auto text = git_show(argument);
  if (!text) {
    LoadResult none;
    none.diagnostics.push_back({Diagnostic::Severity::error, argument, 0, 0, "git: " + text.error(),
                                "write REVISION:PATH inside a repository, the path from its top (or ./PATH), "
                                "as in HEAD~1:config/cell.yaml"});
    return none;
  }
  LockFile lock{argument + ".lock", {}, LockUse::read};
  if (auto locked = git_show(lock.path)) lock.text = std::move(*locked);
  return load_map_with_lock(*text, argument, std::move(lock));
}

}  // namespace

Map MapArgument::map() const {
  if (!node) return loaded.map->map();
  Map map = found_at(loaded.map->map(), *node);
  map.connection.tls = tls;
  return map;
}

MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use, const FindMap& find) {
  if (can_be_a_device(argument)) return from_device(argument, tls, find ? find : served_map);
  return from_file(use == LockUse::renew ? load_and_renew_lock(argument) : load_map_file(argument, use));
}

MapArgument get_version(const std::string& argument, const TlsTexts& tls) {
  return names_a_revision(argument) ? from_file(load_revision(argument)) : get_map(argument, tls);
}

}  // namespace coupler::tools
