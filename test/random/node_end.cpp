// SPDX-License-Identifier: Apache-2.0
#include "test/random/node_end.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <future>
#include <mutex>
#include <optional>

#include "coupler/device/node/io_service.hpp"

namespace coupler::random {

/// Work for the node's thread, and the end of it.
class NodeEnd::Bell : public device::EventHandler {
 public:
  explicit Bell(device::Loop& loop) : loop_(loop), event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (!loop_.watch(event_.get(), device::Interest::read, *this)) std::abort();
  }
  virtual ~Bell() { loop_.forget(event_.get(), *this); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  void ready(device::TimePoint) override {
    std::uint64_t rung = 0;
    if (::read(event_.get(), &rung, sizeof rung) != sizeof rung) return;
    const std::lock_guard lock(mutex_);
    if (!work_) return;
    (*work_)();
    work_.reset();
  }
  void do_soon(std::packaged_task<void()> work) {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
    ring();
  }
  void ring() const {
    const std::uint64_t one = 1;
    if (::write(event_.get(), &one, sizeof one) != sizeof one) std::abort();
  }

  std::atomic<bool> is_over{false};

 private:
  device::Loop& loop_;
  Descriptor event_;
  std::mutex mutex_;
  std::optional<std::packaged_task<void()>> work_;
};

NodeEnd::NodeEnd(const Map& map, device::Hooks* hooks)
    : simulated_(std::any_of(map.points.begin(), map.points.end(), has_hardware)) {
  auto listener = device::listen_on("127.0.0.1", 0);
  auto wiring = device::prepare_wiring(map, simulated_, nullptr, false, log_);
  if (!listener || !wiring) std::abort();
  context_.map = &map;
  context_.listener = *std::move(listener);
  context_.state = std::make_unique<device::SharedState>(map, device::TimePoint::clock::now());
  if (hooks != nullptr) hooks->allow_setting(nullptr);
  if (hooks != nullptr)
    context_.hooked = std::make_unique<device::HookedPoints>(map, context_.state->image(), *hooks);
  context_.wiring = (*wiring)->take_over();
  bell_ = std::make_unique<Bell>(loop_);
  thread_ = std::thread([this] { run(); });
}

NodeEnd::~NodeEnd() {
  bell_->is_over = true;
  bell_->ring();
  thread_.join();
}

void NodeEnd::run() {
  device::IoService service(context_, loop_, log_);
  service.run([this](device::TimePoint) { return bell_->is_over.load(); }, [] {});
}

std::uint16_t NodeEnd::port() const {
  const std::string& name = context_.listener.name;
  return static_cast<std::uint16_t>(std::stoi(name.substr(name.rfind(':') + 1)));
}

bool NodeEnd::is_shown(const Point& point) const {
  const auto ends_here = [&](const SimWire& wire) { return wire.to == point.name; };
  const auto& wires = context_.map->sim;
  return is_set_by_firmware(point) && !(simulated_ && std::any_of(wires.begin(), wires.end(), ends_here));
}

void NodeEnd::between_requests(const std::function<void()>& work) {
  std::packaged_task<void()> task(work);
  auto done = task.get_future();
  bell_->do_soon(std::move(task));
  done.get();
}

std::vector<std::uint16_t> NodeEnd::raw(const Point& point) {
  std::vector<std::uint16_t> raw;
  between_requests([&] {
    const auto cells = context_.state->image().find(point.table, range(point));
    raw.assign(cells.begin(), cells.end());
  });
  if (is_partial(point)) raw[0] = static_cast<std::uint16_t>(raw[0] & codec::mask(point.format));
  return raw;
}

void NodeEnd::put(const Point& point, const std::vector<std::uint16_t>& raw) {
  const std::uint16_t mask = is_partial(point) ? codec::mask(point.format) : 0xFFFF;
  between_requests([&] {
    const auto cells = context_.state->image().find(point.table, range(point));
    for (std::size_t i = 0; i < raw.size(); ++i)
      cells[i] = static_cast<std::uint16_t>((cells[i] & ~mask) | raw[i]);
  });
}

}  // namespace coupler::random
