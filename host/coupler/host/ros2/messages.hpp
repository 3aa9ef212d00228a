// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <coupler_driver/msg/bool_array.hpp>
#include <coupler_driver/msg/bool_sample.hpp>
#include <coupler_driver/msg/bool_stamped.hpp>
#include <coupler_driver/msg/float64_sample.hpp>
#include <coupler_driver/msg/float64_stamped.hpp>
#include <coupler_driver/msg/int64_sample.hpp>
#include <coupler_driver/msg/int64_stamped.hpp>
#include <coupler_driver/msg/string_sample.hpp>
#include <coupler_driver/msg/string_stamped.hpp>
#include <coupler_driver/msg/u_int64_sample.hpp>
#include <coupler_driver/msg/u_int64_stamped.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/char.hpp>
#include <std_msgs/msg/float32.hpp>
#include <std_msgs/msg/float32_multi_array.hpp>
#include <std_msgs/msg/float64.hpp>
#include <std_msgs/msg/float64_multi_array.hpp>
#include <std_msgs/msg/int16.hpp>
#include <std_msgs/msg/int16_multi_array.hpp>
#include <std_msgs/msg/int32.hpp>
#include <std_msgs/msg/int32_multi_array.hpp>
#include <std_msgs/msg/int64.hpp>
#include <std_msgs/msg/int64_multi_array.hpp>
#include <std_msgs/msg/int8.hpp>
#include <std_msgs/msg/string.hpp>
#include <std_msgs/msg/u_int16.hpp>
#include <std_msgs/msg/u_int16_multi_array.hpp>
#include <std_msgs/msg/u_int32.hpp>
#include <std_msgs/msg/u_int32_multi_array.hpp>
#include <std_msgs/msg/u_int64.hpp>
#include <std_msgs/msg/u_int64_multi_array.hpp>
#include <std_msgs/msg/u_int8.hpp>

#include "coupler/host/ros/message.hpp"
#include "coupler/host/ros/stamped_message.hpp"

namespace coupler::host {

/// The message types of ROS 2, for with_message() and with_stamped_message().
struct Ros2Messages {
  using Bool = std_msgs::msg::Bool;
  using BoolArray = coupler_driver::msg::BoolArray;
  using BoolSample = coupler_driver::msg::BoolSample;
  using BoolStamped = coupler_driver::msg::BoolStamped;
  using Char = std_msgs::msg::Char;
  using Float32 = std_msgs::msg::Float32;
  using Float32MultiArray = std_msgs::msg::Float32MultiArray;
  using Float64 = std_msgs::msg::Float64;
  using Float64MultiArray = std_msgs::msg::Float64MultiArray;
  using Float64Sample = coupler_driver::msg::Float64Sample;
  using Float64Stamped = coupler_driver::msg::Float64Stamped;
  using Int16 = std_msgs::msg::Int16;
  using Int16MultiArray = std_msgs::msg::Int16MultiArray;
  using Int32 = std_msgs::msg::Int32;
  using Int32MultiArray = std_msgs::msg::Int32MultiArray;
  using Int64 = std_msgs::msg::Int64;
  using Int64MultiArray = std_msgs::msg::Int64MultiArray;
  using Int64Sample = coupler_driver::msg::Int64Sample;
  using Int64Stamped = coupler_driver::msg::Int64Stamped;
  using Int8 = std_msgs::msg::Int8;
  using String = std_msgs::msg::String;
  using StringSample = coupler_driver::msg::StringSample;
  using StringStamped = coupler_driver::msg::StringStamped;
  using UInt16 = std_msgs::msg::UInt16;
  using UInt16MultiArray = std_msgs::msg::UInt16MultiArray;
  using UInt32 = std_msgs::msg::UInt32;
  using UInt32MultiArray = std_msgs::msg::UInt32MultiArray;
  using UInt64 = std_msgs::msg::UInt64;
  using UInt64MultiArray = std_msgs::msg::UInt64MultiArray;
  using UInt64Sample = coupler_driver::msg::UInt64Sample;
  using UInt64Stamped = coupler_driver::msg::UInt64Stamped;
  using UInt8 = std_msgs::msg::UInt8;
};

}  // namespace coupler::host
