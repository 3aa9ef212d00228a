// SPDX-License-Identifier: Apache-2.0
#include "test/bench/kernel/line.hpp"

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstring>

#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {

const unsigned long long both_edges =
    GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING;

Line::Line(const char* chip, unsigned offset, unsigned long long flags) {
  const int device = ::open(chip, O_RDWR | O_CLOEXEC);
  if (device < 0) give_up("cannot open the chip");
  gpio_v2_line_request request{};
  request.offsets[0] = offset;
  request.num_lines = 1;
  request.config.flags = flags;
  std::strcpy(request.consumer, "bench");
  if (::ioctl(device, GPIO_V2_GET_LINE_IOCTL, &request) != 0) give_up("cannot request a line");
  ::close(device);
  descriptor_ = request.fd;
}

Line::~Line() { ::close(descriptor_); }

bool Line::read() const {
  gpio_v2_line_values values{};
  values.mask = 1;
  if (::ioctl(descriptor_, GPIO_V2_LINE_GET_VALUES_IOCTL, &values) != 0) give_up("cannot read a line");
  return (values.bits & 1) != 0;
}

void Line::drive(bool level) const {
  gpio_v2_line_values values{};
  values.mask = 1;
  values.bits = level ? 1 : 0;
  if (::ioctl(descriptor_, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) != 0) give_up("cannot drive a line");
}

Line::Edge Line::next_edge() const {
  gpio_v2_line_event event{};
  if (::read(descriptor_, &event, sizeof event) != sizeof event) give_up("cannot wait for an edge");
  return {static_cast<std::int64_t>(event.timestamp_ns), event.id == GPIO_V2_LINE_EVENT_RISING_EDGE};
}

}  // namespace coupler::bench
