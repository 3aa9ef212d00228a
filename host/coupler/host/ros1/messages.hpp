// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <coupler_driver/BoolArray.h>
#include <coupler_driver/BoolSample.h>
#include <coupler_driver/BoolStamped.h>
#include <coupler_driver/Float64Sample.h>
#include <coupler_driver/Float64Stamped.h>
#include <coupler_driver/Int64Sample.h>
#include <coupler_driver/Int64Stamped.h>
#include <coupler_driver/StringSample.h>
#include <coupler_driver/StringStamped.h>
#include <coupler_driver/UInt64Sample.h>
#include <coupler_driver/UInt64Stamped.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Char.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float32MultiArray.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/Int16.h>
#include <std_msgs/Int16MultiArray.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int64.h>
#include <std_msgs/Int64MultiArray.h>
#include <std_msgs/Int8.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt16.h>
#include <std_msgs/UInt16MultiArray.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt32MultiArray.h>
#include <std_msgs/UInt64.h>
#include <std_msgs/UInt64MultiArray.h>
#include <std_msgs/UInt8.h>

#include "coupler/host/ros/message.hpp"
#include "coupler/host/ros/stamped_message.hpp"

namespace coupler::host {

/// The message types of ROS 1, for with_message() and with_stamped_message().
struct Ros1Messages {
  using Bool = std_msgs::Bool;
  using BoolArray = coupler_driver::BoolArray;
  using BoolSample = coupler_driver::BoolSample;
  using BoolStamped = coupler_driver::BoolStamped;
  using Char = std_msgs::Char;
  using Float32 = std_msgs::Float32;
  using Float32MultiArray = std_msgs::Float32MultiArray;
  using Float64 = std_msgs::Float64;
  using Float64MultiArray = std_msgs::Float64MultiArray;
  using Float64Sample = coupler_driver::Float64Sample;
  using Float64Stamped = coupler_driver::Float64Stamped;
  using Int16 = std_msgs::Int16;
  using Int16MultiArray = std_msgs::Int16MultiArray;
  using Int32 = std_msgs::Int32;
  using Int32MultiArray = std_msgs::Int32MultiArray;
  using Int64 = std_msgs::Int64;
  using Int64MultiArray = std_msgs::Int64MultiArray;
  using Int64Sample = coupler_driver::Int64Sample;
  using Int64Stamped = coupler_driver::Int64Stamped;
  using Int8 = std_msgs::Int8;
  using String = std_msgs::String;
  using StringSample = coupler_driver::StringSample;
  using StringStamped = coupler_driver::StringStamped;
  using UInt16 = std_msgs::UInt16;
  using UInt16MultiArray = std_msgs::UInt16MultiArray;
  using UInt32 = std_msgs::UInt32;
  using UInt32MultiArray = std_msgs::UInt32MultiArray;
  using UInt64 = std_msgs::UInt64;
  using UInt64MultiArray = std_msgs::UInt64MultiArray;
  using UInt64Sample = coupler_driver::UInt64Sample;
  using UInt64Stamped = coupler_driver::UInt64Stamped;
  using UInt8 = std_msgs::UInt8;
};

}  // namespace coupler::host
