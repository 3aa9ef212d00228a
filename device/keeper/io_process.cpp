// SPDX-License-Identifier: Apache-2.0
#include "device/keeper/io_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace coupler::node {
namespace {

class PipePulse : public Pulse {
 public:
  explicit PipePulse(Descriptor pipe) : pipe_(std::move(pipe)) {}
  void beat() override {
    // A full pipe holds beats enough.
    const char beat = 1;
    [[maybe_unused]] const ssize_t written = ::write(pipe_.get(), &beat, 1);
  }

 private:
  Descriptor pipe_;
};

/// The life of the child.
[[noreturn]] void live(const IoProcess::Work& work, Descriptor pipe, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-node-io");
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  // The parent may have died before the kernel was asked to tell of it.
  if (::getppid() != parent) ::_exit(0);
  PipePulse pulse(std::move(pipe));
  ::_exit(work(pulse));
}

std::string describe(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("exited with status {}", WEXITSTATUS(status));
}

}  // namespace

tl::expected<std::unique_ptr<IoProcess>, int> IoProcess::start(Loop& loop, const Work& work, Pulse* heard) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) return tl::unexpected(errno);
  Descriptor reading(pipe[0]);
  Descriptor writing(pipe[1]);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) return tl::unexpected(errno);
  if (pid == 0) {
    reading.close();
    live(work, std::move(writing), parent);
  }
  return std::unique_ptr<IoProcess>(new IoProcess(loop, pid, std::move(reading), heard));
}

IoProcess::IoProcess(Loop& loop, pid_t pid, Descriptor beats, Pulse* heard)
    : loop_(loop), pid_(pid), beats_(std::move(beats)), heard_(heard), last_beat_(TimePoint::clock::now()) {
  // Unwatched, it would be taken for one that does not beat.
  [[maybe_unused]] const bool watched = loop_.watch(beats_.get(), Interest::read, *this);
  assert(watched);
}

IoProcess::~IoProcess() { loop_.forget(beats_.get(), *this); }

void IoProcess::ready(TimePoint now) {
  std::array<char, 64> beats{};
  const ssize_t count = ::read(beats_.get(), beats.data(), beats.size());
  if (count == 0) {
    ended_ = true;
    loop_.change(beats_.get(), Interest::nothing, *this);
  }
  if (count <= 0) return;
  last_beat_ = now;
  if (heard_ != nullptr) heard_->beat();
}

void IoProcess::terminate() { ::kill(pid_, SIGTERM); }

std::string IoProcess::end() {
  ::kill(pid_, SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  return describe(status);
}

}  // namespace coupler::node
