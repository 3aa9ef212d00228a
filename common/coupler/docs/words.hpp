// SPDX-License-Identifier: Apache-2.0
// Parts of the model as text for people.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "coupler/map/point.hpp"

namespace coupler::docs {

/// "coils", "discrete inputs" …
std::string words(Table table);
/// "read", "write", "read, write"
std::string_view words(Access access);
/// "500 ms", "40 µs", "2 s": the largest unit that needs no fraction.
std::string words(std::chrono::nanoseconds duration);
/// "raw × 0.1 - 40"; empty without a scale.
std::string words(const codec::Scale& scale);
/// "GPIO17", "gpiochip0 line 4"
std::string words(const Line& line);
/// "active low, pull-up, debounce 5 ms"; empty if all is as usual.
std::string details(const Line& line);
/// Returns a text such as "0x8000, 0xFFF0 to 0xFFFF".
std::string words(Span<const RawRange> ranges);
/// Returns a text such as "below 3600, above 21000"; empty if there are none.
std::string words(const Faults& faults);
/// "rising edges of button"
std::string words(const EdgeOf& edge);

/// "-32768 … 32767" as it is published; empty if the type has no limits to show (texts, bits, floating
/// point).
std::string range_words(const Point& point);

/// Returns what registers in the form of Point::initial mean, as it is published: "on", "2.5", "1, 2, 3", "0
/// each".
std::string value_words(const Point& point, Span<const std::uint16_t> registers);

/// The message type of the point's topics, "std_msgs/Float32". coupler/host/ros/message.hpp chooses it for
/// the driver; tests of the driver compare the two.
std::string ros_message(const Point& point);

}  // namespace coupler::docs
