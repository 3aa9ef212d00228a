// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/worker.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <utility>
#include <variant>

#include "coupler/device/net/message.hpp"
#include "coupler/device/net/signals.hpp"

namespace coupler::device {
namespace {

// The messages between both processes.
struct Beat {};
struct MakeRoom {};
struct Ended {};    ///< the other process has ended
struct Nothing {};  ///< for now
using Message = std::variant<Beat, MakeRoom, OpenConnection, Ended, Nothing>;

constexpr std::uint8_t beat_tag = 'B';
constexpr std::uint8_t make_room_tag = 'R';

/// Without waiting: a message that the socket does not take is lost.
void send(int socket, std::uint8_t tag) { (void)send_message(socket, {{&tag, 1}}, -1, Waits::no); }

/// Without waiting.
Message receive(int socket) {
  std::array<std::uint8_t, longest_client_message> bytes{};
  Descriptor descriptor;
  const ssize_t size = receive_message(socket, bytes, descriptor);
  // An error (the other process ended and left something unread) comes once; what it sent comes after that.
  if (size < 0) return Nothing{};
  if (size == 0) return Ended{};
  if (bytes[0] == beat_tag) return Beat{};
  if (bytes[0] == make_room_tag) return MakeRoom{};
  auto client = parse_client(Span<const std::uint8_t>(bytes).first(static_cast<std::size_t>(size)),
                             std::move(descriptor));
  return client ? Message(*std::move(client)) : Message(Nothing{});
}

/// The life of the child. Its end of the channel is closed by the kernel, when its exit status is settled.
[[noreturn]] void live(const Worker::Work& work, Descriptor channel, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-node-io");
  // At a terminal it stays in the supervisor's group: another one could not read what somebody types.
  if (!has_terminal()) ::setpgid(0, 0);
  if (!end_with_parent(parent, SIGTERM)) ::_exit(0);
  SupervisorLink supervisor(std::move(channel), parent);
  ::_exit(work(supervisor));
}

}  // namespace

void SupervisorLink::watch(Loop& loop) {
  loop_ = &loop;
  [[maybe_unused]] const bool watched = loop.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

void SupervisorLink::beat() { send(channel_.get(), beat_tag); }

void SupervisorLink::give(const OpenConnection& client) {
  (void)send_client(channel_.get(), client, Waits::until_it_is_taken);
}

bool SupervisorLink::is_silent(TimePoint now) {
  silence_.sample(now, std::exchange(heard_, false), std::chrono::nanoseconds(0));
  return silence_.lasted() >= timeout;
}

void SupervisorLink::ready(TimePoint) {
  const Message message = receive(channel_.get());
  heard_ |= std::holds_alternative<Beat>(message);
  if (std::holds_alternative<MakeRoom>(message)) wants_room_ = true;
  // The kernel sends SIGTERM when the supervisor dies.
  if (std::holds_alternative<Ended>(message)) loop_->forget(channel_.get(), *this);
}

tl::expected<std::unique_ptr<Worker>, int> Worker::start(Loop& loop, const Work& work,
                                                         std::function<void()> on_beat) {
  auto pair = open_channel();
  if (!pair) return tl::unexpected(errno);
  const pid_t parent = ::getpid();
  auto child = Child::start([&]() -> int {
    pair->one.close();
    live(work, std::move(pair->other), parent);
  });
  if (!child) return tl::unexpected(child.error());
  return std::unique_ptr<Worker>(
      new Worker(loop, *std::move(child), std::move(pair->one), std::move(on_beat)));
}

Worker::Worker(Loop& loop, Child child, Descriptor channel, std::function<void()> on_beat)
    : loop_(loop),
      child_(std::move(child)),
      channel_(std::move(channel)),
      on_beat_(std::move(on_beat)),
      last_beat_(TimePoint::clock::now()) {
  // Unwatched, it would seem silent.
  [[maybe_unused]] const bool watched = loop_.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

Worker::~Worker() { loop_.forget(channel_.get(), *this); }

void Worker::ready(TimePoint now) {
  Message message = receive(channel_.get());
  if (std::holds_alternative<Ended>(message)) {
    ended_ = true;
    loop_.forget(channel_.get(), *this);
  } else if (auto* client = std::get_if<OpenConnection>(&message)) {
    clients_.push_back(std::move(*client));
  } else if (std::holds_alternative<Beat>(message)) {
    last_beat_ = now;
    on_beat_();
  }
}

void Worker::make_room() { send(channel_.get(), make_room_tag); }

void Worker::beat() { send(channel_.get(), beat_tag); }

void Worker::terminate(int signal) { child_.signal(signal); }

Worker::End Worker::end() {
  const auto status = child_.kill();
  if (!status) return {false, false, "cannot be killed (it hangs in a system call)"};
  return {ended_well(*status), true, describe_end(*status)};
}

}  // namespace coupler::device
