// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/map_argument.hpp"

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

#include "coupler/cli/live_device.hpp"
#include "coupler/generate/output.hpp"

namespace coupler::cli {
namespace {

MapArgument no_map(Exit exit, const std::string& argument, std::string what, std::string remedy) {
  MapArgument none;
  none.exit = exit;
  none.loaded.diagnostics.push_back(
      {Diagnostic::Severity::error, argument, 0, 0, std::move(what), std::move(remedy)});
  return none;
}

MapArgument from_node(const std::string& argument, const TlsTexts& tls) {
  const auto node = parse_node_address(argument);
  if (!node) return no_map(bad_call, argument, node.error().what, node.error().remedy);
  if (!node->tls && any_given(tls))
    return no_map(bad_call, argument, "certificates are for a place with TLS",
                  "write tls:// in place of tcp://");
  MapArgument found{{}, ok, *node};
  if (const auto problem = use_tls_options(*node, tls, found.tls))
    return no_map(bad_call, argument, "tls:// needs certificates", *problem);
  Connection connection = found_at({}, *node).connection;
  connection.tls = found.tls;
  auto map = fetch_live_map(connection);
  if (!map) return no_map(map.error().exit, argument, map.error().what, map.error().remedy);
  found.loaded.map = std::move(*map);
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
    std::rewind(file_);
    while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), file_))
      text.append(piece.data(), got);
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
  return tl::unexpected<std::string>(said.rfind("fatal: ", 0) == 0 ? said.substr(7) : said);
}

/// REVISION:PATH, and not a file of that name.
bool names_a_revision(const std::string& argument) {
  const auto colon = argument.find(':');
  std::error_code ignored;
  return colon != std::string::npos && colon != 0 && colon + 1 < argument.size() &&
         !std::filesystem::exists(argument, ignored);
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

MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use) {
  if (names_a_node(argument)) return from_node(argument, tls);
  return from_file(use == LockUse::renew ? load_and_renew_lock(argument) : load_map_file(argument, use));
}

MapArgument get_version(const std::string& argument, const TlsTexts& tls) {
  if (names_a_node(argument) || !names_a_revision(argument)) return get_map(argument, tls);
  return from_file(load_revision(argument));
}

}  // namespace coupler::cli
