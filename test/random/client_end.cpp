// SPDX-License-Identifier: Apache-2.0
#include "test/random/client_end.hpp"

#include "coupler/test_vectors/cases.hpp"

namespace coupler::random {
namespace {

struct Handle : client::PointHandle {
  Handle(client::Session& session, std::uint32_t point) : PointHandle(session, point) {}
  using PointHandle::sample;
  using PointHandle::write;
};

}  // namespace

client::PendingWrite RunTimeClient::set(std::uint32_t point, const Values& values) {
  const Point& written = map_.points[point];
  std::vector<std::uint16_t> registers(range(written).count());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!test_vectors::encode(values[i], written, &registers[i * codec::registers(written.format)]))
      return client::refused("none of the point");
  return Handle(*this, point).write(registers.data());
}

std::optional<Values> RunTimeClient::get(std::uint32_t point) {
  const auto sample = Handle(*this, point).sample();
  if (!sample || sample->quality != client::Quality::good) return std::nullopt;
  const Point& read = map_.points[point];
  Values values;
  for (std::size_t i = 0; i < read.count; ++i)
    values.push_back(test_vectors::decode(read, &sample->registers[i * codec::registers(read.format)]));
  return values;
}

}  // namespace coupler::random
