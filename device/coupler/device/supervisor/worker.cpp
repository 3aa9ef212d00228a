// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/worker.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <csignal>
#include <utility>

#include "coupler/device/net/signals.hpp"
#include "coupler/device/supervisor/channel.hpp"

namespace coupler::device {
namespace {

/// The life of the child. Its end of the channel is closed by the kernel, when its exit status is settled.
[[noreturn]] void live(const Worker::Work& work, Descriptor channel, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-node-io");
  // At a terminal it stays in the supervisor's group: another one could not read what somebody types.
  if (!has_terminal()) ::setpgid(0, 0);
  if (!end_with_parent(parent, SIGTERM)) ::_exit(0);
  SupervisorLink supervisor(std::move(channel));
  ::_exit(work(supervisor));
}

}  // namespace

tl::expected<std::unique_ptr<Worker>, int> Worker::start(Loop& loop, const Work& work, Heartbeat* heard) {
  auto pair = channel::open();
  if (!pair) return tl::unexpected(errno);
  const pid_t parent = ::getpid();
  auto child = Child::start([&]() -> int {
    pair->one.close();
    live(work, std::move(pair->other), parent);
  });
  if (!child) return tl::unexpected(child.error());
  return std::unique_ptr<Worker>(new Worker(loop, *std::move(child), std::move(pair->one), heard));
}

Worker::Worker(Loop& loop, Child child, Descriptor channel, Heartbeat* heard)
    : loop_(loop),
      child_(std::move(child)),
      channel_(std::move(channel)),
      heard_(heard),
      last_beat_(TimePoint::clock::now()) {
  // Unwatched, it would be taken for one that does not beat.
  [[maybe_unused]] const bool watched = loop_.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

Worker::~Worker() { loop_.forget(channel_.get(), *this); }

void Worker::ready(TimePoint now) {
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

void Worker::make_room() { channel::send(channel_.get(), channel::MakeRoom{}); }

void Worker::beat() { channel::send(channel_.get(), channel::Beat{}); }

void Worker::terminate(int signal) { child_.signal(signal); }

Worker::End Worker::end() {
  const auto status = child_.kill();
  if (!status)
    return {false, false, "does not end when it is killed (it is in a call of the kernel that hangs)"};
  return {ended_well(*status), true, describe_end(*status)};
}

}  // namespace coupler::device
