// SPDX-License-Identifier: Apache-2.0
#include "device/keeper/io_process.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "device/keeper/channel.hpp"

namespace coupler::node {
namespace {

/// The life of the child.
[[noreturn]] void live(const IoProcess::Work& work, Descriptor channel, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-node-io");
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  // The parent may have died before the kernel was asked to tell of it.
  if (::getppid() != parent) ::_exit(0);
  Superior superior(std::move(channel));
  ::_exit(work(superior));
}

std::string describe(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("exited with status {}", WEXITSTATUS(status));
}

}  // namespace

tl::expected<std::unique_ptr<IoProcess>, int> IoProcess::start(Loop& loop, const Work& work, Pulse* heard) {
  auto pair = channel::open();
  if (!pair) return tl::unexpected(errno);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) return tl::unexpected(errno);
  if (pid == 0) {
    pair->one.close();
    live(work, std::move(pair->other), parent);
  }
  return std::unique_ptr<IoProcess>(new IoProcess(loop, pid, std::move(pair->one), heard));
}

IoProcess::IoProcess(Loop& loop, pid_t pid, Descriptor channel, Pulse* heard)
    : loop_(loop),
      pid_(pid),
      channel_(std::move(channel)),
      heard_(heard),
      last_beat_(TimePoint::clock::now()) {
  // Unwatched, it would be taken for one that does not beat.
  [[maybe_unused]] const bool watched = loop_.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

IoProcess::~IoProcess() { loop_.forget(channel_.get(), *this); }

void IoProcess::ready(TimePoint now) {
  channel::Message message = channel::receive(channel_.get());
  if (std::holds_alternative<channel::Ended>(message)) {
    ended_ = true;
    loop_.change(channel_.get(), Interest::nothing, *this);
  } else if (auto* client = std::get_if<OpenConnection>(&message)) {
    clients_.push_back(std::move(*client));
  } else if (std::holds_alternative<channel::Beat>(message)) {
    last_beat_ = now;
    if (heard_ != nullptr) heard_->beat();
  }
}

void IoProcess::make_room() { channel::send(channel_.get(), channel::MakeRoom{}); }

void IoProcess::terminate() { ::kill(pid_, SIGTERM); }

IoProcess::End IoProcess::end() {
  ::kill(pid_, SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, describe(status)};
}

}  // namespace coupler::node
