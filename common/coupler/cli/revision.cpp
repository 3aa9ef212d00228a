// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/revision.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace coupler::cli {
namespace {

constexpr int could_not_run = 127;  ///< what posix_spawn()'s child, like a shell, ends with

/// A file without a name: git can write more than a pipe holds while nobody reads.
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

int run(const std::string& object, const Scratch& out, const Scratch& error) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error.descriptor(), STDERR_FILENO);
  // --end-of-options: an argument that begins with a dash is no option of git.
  std::array<std::string, 4> words{"git", "show", "--end-of-options", object};
  std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  pid_t git = 0;
  const int failed = ::posix_spawnp(&git, "git", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return could_not_run;
  int status = 0;
  while (::waitpid(git, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : could_not_run;
}

/// The content, or what git says.
tl::expected<std::string, std::string> show(const std::string& object) {
  const Scratch out;
  const Scratch error;
  if (!out.is_open() || !error.is_open())
    return tl::unexpected<std::string>(fmt::format("no temporary file: {}", std::strerror(errno)));
  const int status = run(object, out, error);
  if (status == 0) return out.content();
  if (status == could_not_run) return tl::unexpected<std::string>("git could not be run");
  std::string said = error.content();
  said = said.substr(0, said.find('\n'));
  return tl::unexpected<std::string>(said.rfind("fatal: ", 0) == 0 ? said.substr(7) : said);
}

}  // namespace

bool names_a_revision(const std::string& argument) {
  const auto colon = argument.find(':');
  std::error_code ignored;
  return colon != std::string::npos && colon != 0 && colon + 1 < argument.size() &&
         !std::filesystem::exists(argument, ignored);
}

LoadResult load_revision(const std::string& argument) {
  auto text = show(argument);
  if (!text) {
    LoadResult none;
    none.diagnostics.push_back({Diagnostic::Severity::error, argument, 0, 0, "git: " + text.error(),
                                "write REVISION:PATH inside a repository, the path from its top (or ./PATH), "
                                "as in HEAD~1:config/cell.yaml"});
    return none;
  }
  LockFile lock{argument + ".lock", {}, LockUse::read};
  if (auto locked = show(lock.path)) lock.text = std::move(*locked);
  return load_map_with_lock(*text, argument, std::move(lock));
}

}  // namespace coupler::cli
