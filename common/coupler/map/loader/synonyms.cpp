// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/synonyms.hpp"

#include <algorithm>

#include "coupler/codec/type_name.hpp"

namespace coupler::loader {
namespace {

using S = Section;

constexpr S bits = S::coil | S::discrete_input;
constexpr S registers = S::input_register | S::holding_register;
constexpr S point = bits | registers;
constexpr S writable = S::coil | S::holding_register;

constexpr std::string_view scale_or_exponent =
    "the factor is 'scale', as in 'scale: 0.1', or 'scale: {exponent_of: POINT}' if the exponent is in a "
    "register";
constexpr std::string_view no_value = "write 'invalid: 0x8000' for a raw value that means 'no value'";
constexpr std::string_view broken_wire =
    "write 'fault_below' or 'fault_above' with the raw value beyond which something is broken";

constexpr Synonym synonyms[] = {
    // The device.
    {"host", "the host of the device is 'address'", S::map},
    {"hostname", "the host of the device is 'address'", S::map},
    {"ip", "the host of the device is 'address'", S::map},
    {"ipaddress", "the host of the device is 'address'", S::map},
    {"slave", "the unit id is 'unit'", S::map},
    {"slaveid", "the unit id is 'unit'", S::map},
    {"unitid", "the unit id is 'unit'", S::map},
    {"deviceid", "the unit id is 'unit'", S::map},
    {"serverid", "the unit id is 'unit'", S::map},
    {"interval", "write 'rate', how often a second; 'rate: 10' is every 100 ms", S::map},
    {"pollinterval", "write 'rate', how often a second; 'rate: 10' is every 100 ms", S::map},
    {"scaninterval", "write 'rate', how often a second; 'rate: 10' is every 100 ms", S::map},
    {"period", "write 'rate', how often a second; 'rate: 10' is every 100 ms", S::map},
    {"pollrate", "the polling rate is 'rate', in Hz", S::map},
    {"frequency", "the polling rate is 'rate', in Hz", S::map},
    {"byteorder",
     "write 'byteorder_reverse: true' if the low byte of a register comes first, or 'order' "
     "for each point",
     S::map},
    {"wordorder",
     "write 'wordorder_reverse: true' if the most significant register comes first, or "
     "'order' for each point",
     S::map},
    {"points", "the points stand in tables below 'mapping', as in 'mapping: {coils: {valve: 0}}'", S::map},
    {"tags", "the points stand in tables below 'mapping', as in 'mapping: {coils: {valve: 0}}'", S::map},
    {"registers", "write 'holding_registers' or 'input_registers' below 'mapping'", S::map},
    {"title", "a map has a 'name'", S::map, true},
    // The tables.
    {"inputs", "write 'discrete_inputs' for bits, or 'input_registers'", S::mapping},
    {"contacts", "bits that can be read are 'discrete_inputs'", S::mapping},
    {"outputs", "write 'coils' for bits, or 'holding_registers'", S::mapping},
    {"registers", "write 'holding_registers' (function codes 3, 6, 16) or 'input_registers' (4)", S::mapping},
    {"holding", "did you mean 'holding_registers'?", S::mapping},
    {"hr", "did you mean 'holding_registers'?", S::mapping},
    {"ir", "did you mean 'input_registers'?", S::mapping},
    {"di", "did you mean 'discrete_inputs'?", S::mapping},
    {"co", "did you mean 'coils'?", S::mapping},
    {"digitalinputs", "did you mean 'discrete_inputs'?", S::mapping},
    {"digitaloutputs", "did you mean 'coils'?", S::mapping},
    {"analoginputs", "did you mean 'input_registers'?", S::mapping},
    {"analogoutputs", "did you mean 'holding_registers'?", S::mapping},
    // Points.
    {"register", "where the point is in its table is 'address'", point},
    {"reg", "where the point is in its table is 'address'", point},
    {"addr", "where the point is in its table is 'address'", point},
    {"number", "where the point is in its table is 'address'", point},
    {"index", "where the point is in its table is 'address'", point},
    {"datatype", "did you mean 'type'?", registers},
    {"format", "did you mean 'type'?", registers},
    {"factor", scale_or_exponent, registers},
    {"scaling", scale_or_exponent, registers},
    {"scalefactor", scale_or_exponent, registers},
    {"multiplier", "the factor is 'scale', as in 'scale: 0.1'", registers},
    {"resolution", "the factor is 'scale', as in 'scale: 0.1'", registers},
    {"divisor", "write 'scale' with the inverse: a divisor of 10 is 'scale: 0.1'", registers},
    {"decimals", "write 'scale': one decimal place is 'scale: 0.1'", registers},
    {"precision", "write 'scale': one decimal place is 'scale: 0.1'", registers},
    {"none", no_value, registers},
    {"invalidvalue", no_value, registers},
    {"nullvalue", no_value, registers},
    {"errorvalue", no_value, registers},
    {"missing", no_value, registers},
    {"sentinel", no_value, registers},
    {"unavailable", no_value, registers},
    {"na", no_value, registers},
    {"fault", broken_wire, registers},
    {"faultvalue", broken_wire, registers},
    {"faultmin", broken_wire, registers},
    {"faultmax", broken_wire, registers},
    {"openwire", broken_wire, registers},
    {"wirebreak", broken_wire, registers},
    {"sf", scale_or_exponent, registers},
    {"nan", no_value, registers},
    {"nanvalue", no_value, registers},
    {"novalue", no_value, registers},
    {"notavailable", no_value, registers},
    {"bias", "what is added is the 'offset' of 'scale', as in 'scale: {gain: 0.1, offset: -40}'", registers},
    {"byteorder", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"wordorder", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"swap", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"endian", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"endianness", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"endianess", "write 'order: ABCD', CDAB, BADC or DCBA; A is the most significant byte", registers},
    {"size", "an array's number of values is 'count'; a STRING's number of bytes is 'length'", registers},
    {"quantity", "an array's number of values is 'count'", point},
    {"default", "the value when the node starts is 'initial'", point},
    {"defaultvalue", "the value when the node starts is 'initial'", point},
    {"value", "the value when the node starts is 'initial'", point},
    {"invert", "a bit that is on at the low level of its line has 'active_low: true'", bits},
    {"inverted", "a bit that is on at the low level of its line has 'active_low: true'", bits},
    {"pin", "the number of a line of its chip is 'offset'", S::coil_line | S::input_line},
    {"line", "the number of a line of its chip is 'offset'", S::coil_line | S::input_line},
    {"number", "the number of a line of its chip is 'offset'", S::coil_line | S::input_line},
    {"gpio", "the GPIO line is 'line'", bits},
    {"pin", "the GPIO line is 'line'", bits},
    {"pull", "the line's resistor is 'bias', as in 'bias: pull_up'", bits},
    {"pullup", "write 'bias: pull_up'", bits},
    {"pulldown", "write 'bias: pull_down'", bits},
    {"readonly", "write 'access: read'", writable},
    {"writeonly", "write 'access: write'", writable},
    {"rw", "write 'access', one of read, write and read_write", writable},
    {"mode", "what a client may do with it is 'access', one of read, write and read_write", writable},
    {"interval", "write 'rate', how often a second; 'rate: 10' is every 100 ms", point},
    {"pollrate", "the polling rate is 'rate', in Hz", point},
    {"uom", "the unit of the value is 'units'", point, true},
    {"unitofmeasurement", "the unit of the value is 'units'", point, true},
    {"desc", "did you mean 'description'?", point, true},
    {"comment", "did you mean 'description'?", point, true},
    {"label", "did you mean 'description'?", point, true},
    {"note", "did you mean 'description'?", point, true},
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

constexpr std::string_view of_halves =
    "no order swaps registers within the halves of 64 bits only; map each half of such a value as a point of "
    "32 "
    "bits with an order of its own, and join them in your program";

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
    {"order", "abcdefgh", "write ABCD: a value of 64 bits has the names of one of 32 bits"},
    {"order", "ghefcdab", "write CDAB: a value of 64 bits has the names of one of 32 bits"},
    {"order", "badcfehg", "write BADC: a value of 64 bits has the names of one of 32 bits"},
    {"order", "hgfedcba", "write DCBA: a value of 64 bits has the names of one of 32 bits"},
    {"order", "cdabghef", of_halves},
    {"order", "efghabcd", of_halves},
    {"order", "dcbahgfe", of_halves},
    {"order", "fehgbadc", of_halves},
    {"bias", "up", "did you mean 'pull_up'?"},
    {"bias", "down", "did you mean 'pull_down'?"},
    {"addressing", "0", "did you mean 'zero_based'?"},
    {"addressing", "zero", "did you mean 'zero_based'?"},
    {"addressing", "1", "write 'modicon': its numbers count from 1"},
    {"addressing", "onebased", "write 'modicon': its numbers count from 1"},
};

}  // namespace

const Synonym* find_synonym(std::string_view word, Section section) {
  const std::string plain = codec::folded_type_name(word);
  const auto* found = std::find_if(std::begin(synonyms), std::end(synonyms), [&](const Synonym& each) {
    return overlap(each.sections, section) && each.word == plain;
  });
  return found == std::end(synonyms) ? nullptr : found;
}

std::string_view remedy_for_choice(std::string_view word, std::string_view key) {
  const std::string plain = codec::folded_type_name(word);
  const auto* found = std::find_if(std::begin(choices), std::end(choices), [&](const ChoiceSynonym& each) {
    return each.key == key && each.word == plain;
  });
  return found == std::end(choices) ? std::string_view{} : found->remedy;
}

}  // namespace coupler::loader
