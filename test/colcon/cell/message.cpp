// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <coupler_driver/msg/status.hpp>

int main() {
  coupler_driver::msg::Status status;
  status.online = true;
  std::puts(status.online ? "online" : "offline");
}
