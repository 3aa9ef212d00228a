// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/map_reading.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <memory_resource>
#include <new>
#include <utility>

#include "coupler/device/tls_process/tls_settings.hpp"

namespace coupler::device {
namespace {

enum Status { done, logged, too_large, no_settings };

/// Returns the text that was written to the memory.
std::string text_in(int memory) {
  std::array<char, 1024> text{};
  const ssize_t size = ::pread(memory, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

}  // namespace

MapReading::MapReading(Loop& loop, TimePoint now)
    : loop_(loop),
      deadline_(now + timeout),
      arena_(std::make_shared<SharedArena>(room)),
      settings_(make_settings_memory()) {}

MapReading::~MapReading() {
  if (is_watched_) loop_.forget(child_->descriptor(), *this);
}

tl::expected<std::unique_ptr<MapReading>, ServeError> MapReading::start(Loop& loop, const ReadMap& source,
                                                                        TimePoint now) {
  const auto failed = [](const char* why) {
    return tl::unexpected(
        ServeError{ServeError::device_failed,
                   fmt::format("the map cannot be read: no process can be started for it: {}", why)});
  };
  try {
    std::unique_ptr<MapReading> reading(new MapReading(loop, now));
    const pid_t parent = ::getpid();
    auto child = Child::start([&] { return reading->read(source, parent); });
    if (!child) return failed(std::strerror(child.error()));
    reading->child_ = *std::move(child);
    // Unwatched, its end is seen a little later.
    reading->is_watched_ = loop.watch(reading->child_->descriptor(), Interest::read, *reading);
    return reading;
  } catch (const std::bad_alloc&) {
    return failed(std::strerror(ENOMEM));
  }
}

/// In the process of its own. Nothing is destroyed in it: the map is the other one's.
int MapReading::read(const ReadMap& source, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-map");
  ::prctl(PR_SET_DUMPABLE, 0);  // it may read a key, which is for no core file
  if (!end_with_parent(parent, SIGKILL)) return logged;
  close_descriptors({source.descriptor, settings_.get()});
  std::pmr::set_default_resource(arena_.get());
  try {
    if (!source.read) ::_exit(read_settings_of(*source.built_in));
    const auto map = source.read();
    if (!map) leave_text(map.error());
    if (!map || *map == nullptr) ::_exit(logged);
    made_[0].map = map->get();
    ::_exit(read_settings_of((*map)->map()));
  } catch (const std::bad_alloc&) {
    return too_large;
  }
}

/// Returns a Status.
int MapReading::read_settings_of(const Map& map) {
  if (!map.security.files.present()) return done;
  const auto settings = tls_settings_of(map);
  if (settings && write_settings(settings_.get(), *settings)) return done;
  leave_text(settings ? "there is no memory for the certificates" : settings.error());
  return no_settings;
}

void MapReading::leave_text(const std::string& why) const {
  (void)!::ftruncate(settings_.get(), 0);
  (void)!::pwrite(settings_.get(), why.data(), why.size(), 0);
}

void MapReading::ready(TimePoint) {
  loop_.forget(child_->descriptor(), *this);
  is_watched_ = false;
}

bool MapReading::is_over(TimePoint now) {
  if (!status_) status_ = child_->wait(std::chrono::milliseconds(0));
  return status_ || now >= deadline_;
}

tl::expected<MapRead, ServeError> MapReading::take() {
  const auto failed = [](ServeError::Reason reason, std::string why) {
    return tl::unexpected(ServeError{reason, std::move(why)});
  };
  if (!status_)
    return failed(ServeError::device_failed,
                  fmt::format("the map could not be read in {} s; check the disk or the network file system "
                              "that it is on",
                              timeout.count()));
  if (*status_ == 0) {
    arena_->give_back_rest();
    return MapRead{MapPtr(arena_, made_[0].map), std::move(settings_)};
  }
  if (!WIFEXITED(*status_))
    return failed(ServeError::device_failed, "the process that read the map " + describe_end(*status_));
  if (WEXITSTATUS(*status_) == no_settings)
    return failed(ServeError::map_is_wrong, "'security': " + text_in(settings_.get()));
  if (WEXITSTATUS(*status_) == too_large)
    return failed(ServeError::map_is_wrong,
                  fmt::format("the map needs more than {} MiB of memory; remove points", room >> 20));
  return tl::unexpected(ServeError{ServeError::map_is_wrong, {}, text_in(settings_.get())});
}

tl::expected<MapRead, ServeError> read_first(const ReadMap& source) {
  Loop loop;
  auto reading = MapReading::start(loop, source, TimePoint::clock::now());
  if (!reading) return tl::unexpected(std::move(reading).error());
  while (!(*reading)->is_over({})) loop.run_once(std::chrono::milliseconds(100));
  return (*reading)->take();
}

}  // namespace coupler::device
