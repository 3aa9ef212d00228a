// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <memory_resource>
#include <thread>

#include "coupler/device/node/map_reading.hpp"

namespace coupler::device {
namespace {

using testing::HasSubstr;

class Reading : public testing::Test {
 protected:
  tl::expected<MapPtr, ServeError> read(std::function<MapPtr()> work) {
    auto reading = MapReading::start(loop_, {std::move(work)}, {});
    EXPECT_TRUE(reading.has_value());
    while (!(*reading)->is_over({})) loop_.run_once(std::chrono::milliseconds(100));
    return (*reading)->take().map([](MapRead read) { return read.map; });
  }

  Loop loop_;
};

TEST_F(Reading, The_map_is_here_when_the_process_that_read_it_is_gone) {
  const auto map = read([] {
    const auto made = OwnedMap::make();
    Point lamp;
    lamp.name = made->keep("lamp");
    lamp.description = made->keep("so long that no string keeps it in itself");
    Map head;
    head.name = made->keep("cell");
    made->finish(head, {lamp}, {});
    return made;
  });
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ((*map)->map().name, "cell");
  ASSERT_EQ((*map)->map().points.size(), 1U);
  EXPECT_EQ((*map)->map().points[0].description, "so long that no string keeps it in itself");
}

TEST_F(Reading, What_the_process_has_told_is_not_told_again) {
  const auto none = read([]() -> MapPtr { return nullptr; });
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().errors, "");
  EXPECT_EQ(none.error().reason, ServeError::map_is_wrong);
}

TEST_F(Reading, A_process_that_dies_is_told) {
  const auto none = read([]() -> MapPtr {
    ::kill(::getpid(), SIGKILL);
    return nullptr;
  });
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().errors, HasSubstr("was killed by signal 9"));
  EXPECT_EQ(none.error().reason, ServeError::device_failed) << "nothing is known of the map";
}

TEST_F(Reading, A_map_that_needs_more_memory_than_any_is_refused) {
  const auto none = read([]() -> MapPtr {
    (void)std::pmr::get_default_resource()->allocate(std::size_t{1} << 30);
    return nullptr;
  });
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().errors, HasSubstr("more than 256 MiB"));
  EXPECT_EQ(none.error().reason, ServeError::map_is_wrong);
}

TEST_F(Reading, One_that_takes_too_long_is_killed) {
  auto reading = MapReading::start(loop_, {[]() -> MapPtr {
                                     for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
                                   }},
                                   {});
  ASSERT_TRUE(reading.has_value());
  EXPECT_FALSE((*reading)->is_over(TimePoint() + MapReading::timeout - std::chrono::seconds(1)));
  EXPECT_TRUE((*reading)->is_over(TimePoint() + MapReading::timeout));
  const auto none = (*reading)->take();
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().errors, HasSubstr("could not be read in 60 s"));
}

TEST_F(Reading, The_process_has_none_of_the_descriptors_but_the_log) {
  const Descriptor lines(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const Descriptor kept(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  SharedArray<std::atomic<int>> open(2);
  auto reading = MapReading::start(loop_,
                                   {[&]() -> MapPtr {
                                      open[0] = ::fcntl(lines.get(), F_GETFD) >= 0;
                                      open[1] = ::fcntl(kept.get(), F_GETFD) >= 0;
                                      return nullptr;
                                    },
                                    kept.get()},
                                   {});
  while (!(*reading)->is_over({})) loop_.run_once(std::chrono::milliseconds(100));
  EXPECT_EQ(open[0], 0);
  EXPECT_EQ(open[1], 1);
}

}  // namespace
}  // namespace coupler::device
