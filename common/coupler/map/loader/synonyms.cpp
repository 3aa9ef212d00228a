// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/synonyms.hpp"

#include <algorithm>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

using S = Section;

constexpr S bits = S::coil | S::discrete_input;
constexpr S registers = S::input_register | S::holding_register;
constexpr S point = bits | registers;
constexpr S writable = S::coil | S::holding_register;

constexpr Synonym synonyms[] = {
    // The device.
    {"host", S::map, "the host of the device is 'address'"},
    {"hostname", S::map, "the host of the device is 'address'"},
    {"ip", S::map, "the host of the device is 'address'"},
    {"ipaddress", S::map, "the host of the device is 'address'"},
    {"slave", S::map, "the unit id is 'unit'"},
    {"slaveid", S::map, "the unit id is 'unit'"},
    {"unitid", S::map, "the unit id is 'unit'"},
    {"deviceid", S::map, "the unit id is 'unit'"},
    {"serverid", S::map, "the unit id is 'unit'"},
    {"interval", S::map, "write 'rate', how often a second; 'rate: 10' is every 100 ms"},
    {"pollinterval", S::map, "write 'rate', how often a second; 'rate: 10' is every 100 ms"},
    {"scaninterval", S::map, "write 'rate', how often a second; 'rate: 10' is every 100 ms"},
    {"period", S::map, "write 'rate', how often a second; 'rate: 10' is every 100 ms"},
    {"pollrate", S::map, "the polling rate is 'rate', in Hz"},
    {"frequency", S::map, "the polling rate is 'rate', in Hz"},
    {"byteorder", S::map,
     "write 'byteorder_reverse: true' if the low byte of a register comes first, or 'order' "
     "for each point"},
    {"wordorder", S::map,
     "write 'wordorder_reverse: true' if the most significant register comes first, or "
     "'order' for each point"},
    {"points", S::map, "the points stand in tables below 'mapping', as in 'mapping: {coils: {valve: 0}}'"},
    {"tags", S::map, "the points stand in tables below 'mapping', as in 'mapping: {coils: {valve: 0}}'"},
    {"registers", S::map, "write 'holding_registers' or 'input_registers' below 'mapping'"},
    {"title", S::map, "a map has a 'name'", true},
    // The tables.
    {"inputs", S::mapping, "write 'discrete_inputs' for bits, or 'input_registers'"},
    {"contacts", S::mapping, "bits that can be read are 'discrete_inputs'"},
    {"outputs", S::mapping, "write 'coils' for bits, or 'holding_registers'"},
    {"registers", S::mapping, "write 'holding_registers' (function codes 3, 6, 16) or 'input_registers' (4)"},
    {"holding", S::mapping, "did you mean 'holding_registers'?"},
    {"hr", S::mapping, "did you mean 'holding_registers'?"},
    {"ir", S::mapping, "did you mean 'input_registers'?"},
    {"di", S::mapping, "did you mean 'discrete_inputs'?"},
    {"co", S::mapping, "did you mean 'coils'?"},
    {"digitalinputs", S::mapping, "did you mean 'discrete_inputs'?"},
    {"digitaloutputs", S::mapping, "did you mean 'coils'?"},
    {"analoginputs", S::mapping, "did you mean 'input_registers'?"},
    {"analogoutputs", S::mapping, "did you mean 'holding_registers'?"},
    // Points.
    {"register", point, "where the point is in its table is 'address'"},
    {"reg", point, "where the point is in its table is 'address'"},
    {"addr", point, "where the point is in its table is 'address'"},
    {"number", point, "where the point is in its table is 'address'"},
    {"index", point, "where the point is in its table is 'address'"},
    {"datatype", registers, "did you mean 'type'?"},
    {"format", registers, "did you mean 'type'?"},
    {"factor", registers, "the factor is 'scale', as in 'scale: 0.1'"},
    {"scaling", registers, "the factor is 'scale', as in 'scale: 0.1'"},
    {"scalefactor", registers, "the factor is 'scale', as in 'scale: 0.1'"},
    {"multiplier", registers, "the factor is 'scale', as in 'scale: 0.1'"},
    {"resolution", registers, "the factor is 'scale', as in 'scale: 0.1'"},
    {"divisor", registers, "write 'scale' with the inverse: a divisor of 10 is 'scale: 0.1'"},
    {"decimals", registers, "write 'scale': one decimal place is 'scale: 0.1'"},
    {"precision", registers, "write 'scale': one decimal place is 'scale: 0.1'"},
    {"bias", registers, "what is added is the 'offset' of 'scale', as in 'scale: {gain: 0.1, offset: -40}'"},
    {"byteorder", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"wordorder", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"swap", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"endian", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"endianness", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"endianess", registers, "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte"},
    {"size", registers, "an array's number of values is 'count'; a STRING's number of bytes is 'length'"},
    {"quantity", point, "an array's number of values is 'count'"},
    {"default", point, "the value when the node starts is 'initial'"},
    {"defaultvalue", point, "the value when the node starts is 'initial'"},
    {"value", point, "the value when the node starts is 'initial'"},
    {"invert", bits, "a bit that is on at the low level of its line has 'active_low: true'"},
    {"inverted", bits, "a bit that is on at the low level of its line has 'active_low: true'"},
    {"gpio", bits, "the GPIO line is 'line'"},
    {"pin", bits, "the GPIO line is 'line'"},
    {"pull", bits, "the line's resistor is 'bias', as in 'bias: pull_up'"},
    {"pullup", bits, "write 'bias: pull_up'"},
    {"pulldown", bits, "write 'bias: pull_down'"},
    {"readonly", writable, "write 'access: read'"},
    {"writeonly", writable, "write 'access: write'"},
    {"rw", writable, "write 'access', one of read, write and read_write"},
    {"mode", writable, "what a client may do with it is 'access', one of read, write and read_write"},
    {"interval", point, "write 'rate', how often a second; 'rate: 10' is every 100 ms"},
    {"pollrate", point, "the polling rate is 'rate', in Hz"},
    {"uom", point, "the unit of the value is 'units'", true},
    {"unitofmeasurement", point, "the unit of the value is 'units'", true},
    {"desc", point, "did you mean 'description'?", true},
    {"comment", point, "did you mean 'description'?", true},
    {"label", point, "did you mean 'description'?", true},
    {"note", point, "did you mean 'description'?", true},
};

/// The words of other programs and manuals for a choice.
struct ChoiceSynonym {
  std::string_view key;
  std::string_view word;
  std::string_view remedy;
};

constexpr std::string_view big_endian = "write ABCD, or AB for one register: the most significant byte first";
constexpr std::string_view little_endian =
    "write DCBA, or BA for one register: the least significant byte first";
constexpr std::string_view swapped =
    "write CDAB if the registers are swapped, BADC if the bytes of each register are";

constexpr ChoiceSynonym choices[] = {
    {"access", "r", "did you mean 'read'?"},
    {"access", "ro", "did you mean 'read'?"},
    {"access", "readonly", "did you mean 'read'?"},
    {"access", "w", "did you mean 'write'?"},
    {"access", "wo", "did you mean 'write'?"},
    {"access", "writeonly", "did you mean 'write'?"},
    {"access", "rw", "did you mean 'read_write'?"},
    {"access", "r/w", "did you mean 'read_write'?"},
    {"access", "readwrite", "did you mean 'read_write'?"},
    {"offset", "msb", "did you mean 'high'?"},
    {"offset", "hi", "did you mean 'high'?"},
    {"offset", "upper", "did you mean 'high'?"},
    {"offset", "lsb", "did you mean 'low'?"},
    {"offset", "lo", "did you mean 'low'?"},
    {"offset", "lower", "did you mean 'low'?"},
    {"order", "big", big_endian},
    {"order", "be", big_endian},
    {"order", "bigendian", big_endian},
    {"order", "little", little_endian},
    {"order", "le", little_endian},
    {"order", "littleendian", little_endian},
    {"order", "swap", swapped},
    {"order", "swapped", swapped},
    {"order", "wordswap", "did you mean 'CDAB'?"},
    {"order", "byteswap", "did you mean 'BADC'?"},
    {"bias", "up", "did you mean 'pull_up'?"},
    {"bias", "down", "did you mean 'pull_down'?"},
    {"addressing", "0", "did you mean 'zero_based'?"},
    {"addressing", "zero", "did you mean 'zero_based'?"},
    {"addressing", "1", "write 'modicon': its numbers count from 1"},
    {"addressing", "onebased", "write 'modicon': its numbers count from 1"},
};

std::string folded(std::string_view word) {
  std::string result = lower(word);
  result.erase(
      std::remove_if(result.begin(), result.end(), [](char c) { return c == '-' || c == '_' || c == ' '; }),
      result.end());
  return result;
}

}  // namespace

const Synonym* find_synonym(std::string_view word, Section section) {
  const std::string plain = folded(word);
  const auto* found = std::find_if(std::begin(synonyms), std::end(synonyms), [&](const Synonym& each) {
    return overlap(each.sections, section) && each.word == plain;
  });
  return found == std::end(synonyms) ? nullptr : found;
}

std::string_view remedy_for_choice(std::string_view word, std::string_view key) {
  const std::string plain = folded(word);
  const auto* found = std::find_if(std::begin(choices), std::end(choices), [&](const ChoiceSynonym& each) {
    return each.key == key && each.word == plain;
  });
  return found == std::end(choices) ? std::string_view{} : found->remedy;
}

}  // namespace coupler::loader
