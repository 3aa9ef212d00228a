// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/tls_process/tls_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/device/tls_process/tls_messages.hpp"

namespace coupler::device {
namespace {

constexpr int no_program = 127;                         // exit status, as a shell has it
constexpr std::chrono::milliseconds longest_turn{200};  // look_after() is called each 100 ms or so

/// Beside this program, as in a build; where an installation has it, seen from this program; where this build
/// has or would have installed it: the program may be another project's. Empty: nowhere.
std::string find_program() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path own = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {own, own / ".." / "libexec" / "coupler", fs::path(COUPLER_LIBEXEC)}) {
    const fs::path program = folder / tls_messages::program_name;
    if (::access(program.c_str(), X_OK) == 0) return program.lexically_normal().string();
  }
  return {};
}

bool is_over(const Silence& silence) { return silence.lasted() - silence.starved() >= TlsProcess::timeout; }

/// In the child. Its descriptors are those two and 0 to 2; its memory is its own. SIGTERM and SIGINT stay
/// blocked, as in this process (Signals), which ends it: a service manager signals all at once.
[[noreturn]] void become(const std::string& program, int control, int clients, pid_t parent) {
  if (!end_with_parent(parent, SIGKILL)) ::_exit(0);
  // Copies above both numbers, then down to them: dup2() clears close-on-exec.
  const int high_control = ::fcntl(control, F_DUPFD, 10);
  const int high_clients = ::fcntl(clients, F_DUPFD, 10);
  ::dup2(high_control, tls_messages::control_descriptor);
  ::dup2(high_clients, tls_messages::clients_descriptor);
  ::close_range(tls_messages::clients_descriptor + 1, ~0U, 0);
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);  // the supervisor opens ports below 1024
  ::execl(program.c_str(), tls_messages::program_name, static_cast<char*>(nullptr));
  ::_exit(no_program);
}

}  // namespace

tl::expected<std::unique_ptr<TlsProcess>, std::string> TlsProcess::start(Loop& loop, Log& log) {
  std::string program = find_program();
  if (program.empty())
    return tl::unexpected(fmt::format(
        "'security' has a certificate, but {} is not installed, neither beside this program nor in "
        "{}: build it with OpenSSL 3 (libssl-dev), or install the package coupler-node",
        tls_messages::program_name, COUPLER_LIBEXEC));
  const auto failed = [](int error) {
    return tl::unexpected(
        fmt::format("{} cannot be started: {}", tls_messages::program_name, std::strerror(error)));
  };
  auto clients = open_channel();
  if (!clients) return failed(errno);
  std::unique_ptr<TlsProcess> process(new TlsProcess(loop, log, std::move(program), *std::move(clients)));
  if (const int error = process->start_process(TimePoint::clock::now()); error != 0) return failed(error);
  return process;
}

TlsProcess::TlsProcess(Loop& loop, Log& log, std::string program, Channel clients)
    : loop_(loop), log_(log), program_(std::move(program)), clients_(std::move(clients)) {}

TlsProcess::~TlsProcess() { end_process(); }

/// 0, or the errno of what failed.
int TlsProcess::start_process(TimePoint now) {
  auto control = open_channel();
  if (!control) return errno;
  const pid_t parent = ::getpid();
  auto child =
      Child::start([&]() -> int { become(program_, control->other.get(), clients_.other.get(), parent); });
  if (!child) return child.error();
  child_ = *std::move(child);
  control_ = std::move(control->one);
  started_ = now;
  cpu_wait_.emplace(child_->pid());
  silence_.emplace(now, longest_turn, cpu_wait_->sample(now));
  if (waits_) unanswered_ = silence_;
  if (!loop_.watch(control_.get(), Interest::read, *this)) return errno;
  answers_to_skip_ = 0;
  if (settings_.is_open()) {
    send(tls_messages::prepare, settings_.get());
    send(tls_messages::commit, listener_.get());
    ++answers_to_skip_;
  }
  // Settings that were prepared and answered are committed later, but to this process.
  if (prepared_.is_open()) send(tls_messages::prepare, prepared_.get());
  if (prepared_.is_open() && !waits_) ++answers_to_skip_;
  return 0;
}

/// "was killed by signal 9 (Killed)"; empty: it has not.
std::string TlsProcess::how_it_ended(std::chrono::milliseconds at_most) {
  const auto status = child_ ? child_->wait(at_most) : std::nullopt;
  if (!status) return {};
  child_.reset();
  end_process();
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == no_program)
    return fmt::format("cannot be executed; 'ldd {}' shows a library that is missing", program_);
  return describe_end(*status);
}

void TlsProcess::end_process() {
  if (control_.is_open()) loop_.forget(control_.get(), *this);
  control_.close();  // it says what is left to say, and ends
  constexpr std::chrono::milliseconds for_last_words{300};
  if (child_) (void)child_->wait(for_last_words);
  child_.reset();
}

void TlsProcess::send(std::uint8_t what, int descriptor) {
  (void)send_message(control_.get(), {{&what, 1}}, descriptor, Waits::no);
}

void TlsProcess::prepare(Descriptor settings) {
  prepared_ = std::move(settings);
  answer_.reset();
  // An answer to something before is not one to this.
  if (std::exchange(waits_, true)) ++answers_to_skip_;
  const TimePoint now = TimePoint::clock::now();
  unanswered_.emplace(now, longest_turn, cpu_wait_->sample(now));
  if (child_) send(tls_messages::prepare, prepared_.get());
}

std::optional<TlsProcess::Answer> TlsProcess::answer(TimePoint now) {
  if (waits_) unanswered_->sample(now, false, cpu_wait_->sample(now));
  if (waits_ && is_over(*unanswered_)) {
    end_process();  // it hangs; another one is started
    give_up(
        {fmt::format("{} did not answer within {} s", tls_messages::program_name, timeout.count()), true});
  }
  return std::exchange(answer_, std::nullopt);
}

void TlsProcess::commit(int listener) {
  settings_ = std::move(prepared_);
  prepared_.close();
  listener_ = Descriptor(::fcntl(listener, F_DUPFD_CLOEXEC, 0));
  if (child_) send(tls_messages::commit, listener_.get());
}

void TlsProcess::look_after(TimePoint now) {
  if (!child_) {
    if (now >= start_again_ && start_process(now) != 0) start_again_ = now + Backoff::longest;
    return;
  }
  std::string how = how_it_ended(std::chrono::milliseconds(0));
  if (how.empty() && is_silent(now)) {
    how = fmt::format("was silent for {:.1f} s", std::chrono::duration<double>(silence_->lasted()).count());
    end_process();
  }
  if (how.empty()) return;
  const auto pause = backoff_.after(now - started_);
  start_again_ = now + pause;
  log_.warn(
      fmt::format("the TLS process {}; its clients have lost their connections; starting it again in {} ms",
                  how, pause.count()));
}

/// Much longer than a worker process may be: nobody's outputs wait for it, and handshakes on a small board
/// take their time.
bool TlsProcess::is_silent(TimePoint now) {
  silence_->sample(now, std::exchange(heard_, false), cpu_wait_->sample(now));
  if (now >= ask_at_) {
    send(tls_messages::alive, -1);
    ask_at_ = now + heartbeat_period;
  }
  return is_over(*silence_);
}

void TlsProcess::leave() {
  control_.close();
  settings_.close();
  listener_.close();
  prepared_.close();
  clients_.other.close();
}

void TlsProcess::ready(TimePoint) {
  std::array<std::uint8_t, 1024> room{};
  Descriptor none;
  const ssize_t size = receive_message(control_.get(), room, none);
  if (size == 0) {
    loop_.forget(control_.get(), *this);
    control_.close();
    if (!waits_) return;  // look_after() sees why
    constexpr std::chrono::milliseconds soon{
        200};  // its end of the channel is closed, so it is about to be gone
    const std::string how = how_it_ended(soon);
    give_up({fmt::format("the TLS process {}", how.empty() ? "closed its channel" : how), true});
    return;
  }
  if (size < 0) return;
  heard_ = true;
  if (room[0] == tls_messages::still_alive) return;
  if (answers_to_skip_ > 0) {
    --answers_to_skip_;
    return;
  }
  if (!std::exchange(waits_, false)) return;
  const std::string_view text(reinterpret_cast<const char*>(room.data()), static_cast<std::size_t>(size));
  if (text[0] == tls_messages::refused)
    give_up({std::string(text.substr(1))});
  else
    answer_ = Answer{};
}

/// Gives up: the prepared settings do not come into force.
void TlsProcess::give_up(Answer answer) {
  waits_ = false;
  prepared_.close();
  answer_ = std::move(answer);
}

}  // namespace coupler::device
