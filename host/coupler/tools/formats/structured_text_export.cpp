// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/allowed_values.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/typed_value.hpp"
#include "coupler/plan/planner.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "coupler/tools/formats/structured_text.hpp"

namespace coupler::formats {
namespace {

using codec::Type;
namespace st = structured_text;

/// "holding registers 3 to 4"
std::string place_text(Table table, modbus::Range range) {
  std::string text(to_string(table));
  std::replace(text.begin(), text.end(), '_', ' ');
  if (range.count() > 1) return fmt::format("{} {} to {}", text, range.start(), range.last());
  text.pop_back();
  return fmt::format("{} {}", text, range.start());
}

/// Returns the comment beside the declaration.
std::string remarks(const Point& point, modbus::Range place) {
  std::string text = place_text(point.table, place);
  const codec::Format& format = point.format;
  if (!holds_bits(point.table)) {
    if (is_partial(point)) text += " " + part_text(point);
    text += fmt::format(", {} {}", to_string(format.type), codec::order_text(format));
    if (format.type == Type::STRING)
      text += fmt::format(", {} bytes {}", format.length, codec::to_string(format.encoding));
  }
  if (point.scale.present()) text += ", " + st::scaled("raw", point.scale);
  if (limits_values(point))
    text += "; " + allowed_text(point);
  else if (!point.units.empty())
    text += fmt::format("; {}", point.units);
  if (!point.description.empty()) text += fmt::format("; {}", point.description);
  return st::comment(text);
}

class Writer {
 public:
  Writer(const Map& map, ConversionWarnings& warnings)
      : map_(map), warnings_(warnings), global_names_(warnings), member_names_(warnings) {}

  std::string write() {
    prefix_ = st::identifier(map_.name);
    prefix_ = global(st::is_reserved(prefix_) ? prefix_ + "_map" : prefix_);
    name_points();
    warn_of_tools(map_, warnings_);
    warn_of_rights(map_, true, warnings_);
    for (const Point& point : map_.points) warn_of_raw_meaning(point, false, warnings_);
    const Side inputs = side("read", "inputs", st::read_blocks(map_));
    const Side outputs = side("write", "outputs", st::write_blocks(map_));
    add_float_functions();
    const std::string copied = copy_read_only_bits(inputs, outputs);
    if (!inputs.blocks.empty()) add_side(inputs, true);
    if (!outputs.blocks.empty())
      add_side(outputs, false, copied.empty() ? "" : fmt::format("  read_image : {};\n", inputs.image_type),
               copied);
    add_constants(inputs, outputs);
    return head() + types_ + functions_ + blocks_ + constants_ + variables_of(inputs, outputs);
  }

 private:
  /// The variables that are read, or those that are written.
  struct Side {
    std::string verb;
    std::vector<st::Block> blocks;
    std::string values_type, image_type, function_block, values, image;
  };

  /// A name of its own among the global ones. The language takes "Lamp" and "lamp" for one name.
  std::string global(const std::string& name, std::string_view point = {}) {
    return unique(global_names_, name, point);
  }
  static std::string unique(UniqueNames& names, const std::string& name, std::string_view point) {
    return name + names.make(lower(name), point).substr(name.size());
  }

  void name_points() {
    for (const Point& point : map_.points) {
      std::string name = st::identifier(point.name);
      if (name != point.name)
        warnings_.add("names that are no identifiers of Structured Text are changed",
                      "rename the points if you want the same names everywhere", point.name);
      if (st::is_reserved(name)) {
        name += "_value";
        warnings_.add("names that are words of Structured Text get '_value'",
                      "rename the points if you want the same names everywhere", point.name);
      }
      names_.push_back(unique(member_names_, name, point.name));
      if (point.format.type == Type::STRING)
        warnings_.add("texts are arrays of bytes, since Structured Text makes no STRING of bytes",
                      "copy the bytes with the PLC's own function, such as MEMCPY", point.name);
      if (is_readable(point) && plan::why_not_read(map_, point))
        warnings_.add("points that no request can read are not among the inputs", "`coupler plan` says why",
                      point.name);
      if (is_writable(point) && point.initial.empty() && !st::may_be_zero(point))
        warnings_.add("outputs begin with the allowed value nearest to 0, since 0 is not allowed",
                      "give 'initial' if they are to begin with another value", point.name);
      if (point.bounds.allow_nonfinite)
        warnings_.add("NaN and infinities are reported in place of being read or written",
                      "no action is needed if the device does without them", point.name);
    }
  }

  Side side(const std::string& verb, const std::string& values, std::vector<st::Block> own_blocks) {
    UniqueNames names(warnings_);
    for (st::Block& block : own_blocks)
      block.name = names.make(fmt::format("{}_{}", to_string(block.table), block.range.start()), {});
    return {verb,
            std::move(own_blocks),
            global(fmt::format("{}_{}_type", prefix_, values)),
            global(fmt::format("{}_{}_image_type", prefix_, verb)),
            global(fmt::format("{}_{}", prefix_, verb == "read" ? "decode" : "encode")),
            global(fmt::format("{}_{}", prefix_, values)),
            global(fmt::format("{}_{}_image", prefix_, verb))};
  }

  void add_float_functions() {
    float_functions_ = {global(prefix_ + "_dword_to_real"), global(prefix_ + "_real_to_dword"),
                        global(prefix_ + "_lword_to_lreal"), global(prefix_ + "_lreal_to_lword")};
    for (const Type type : {Type::REAL, Type::LREAL})
      if (std::any_of(map_.points.begin(), map_.points.end(),
                      [type](const Point& point) { return point.format.type == type; }))
        functions_ += st::float_functions(type, float_functions_) + "\n";
  }

  /// The statements; what is only read would be written as 0 otherwise.
  std::string copy_read_only_bits(const Side& inputs, const Side& outputs) {
    std::string copied;
    for (const st::ReadOnlyBits& bits : st::read_only_bits(map_, inputs.blocks, outputs.blocks)) {
      const std::string_view name = map_.points[bits.point].name;
      if (bits.read == nullptr)
        warnings_.add(
            "read-only bits and bytes that no request can read are written as 0 with their register",
            "put them into the write image, which keeps them, before the first write", name);
      else
        warnings_.add("read-only bits and bytes of registers that are written are copied from the read image",
                      fmt::format("hand it to {} as 'read_image', and read before the first write",
                                  outputs.function_block),
                      name);
      copied += st::copying(bits);
    }
    return copied;
  }

  /// The types and the function block of one direction.
  void add_side(const Side& side, bool reads, const std::string& parameters = {}, std::string body = {}) {
    // In the map's order, which is that of the addresses.
    std::map<std::uint32_t, const st::Block*> block_of;
    std::string image;
    for (const st::Block& block : side.blocks) {
      for (const std::uint32_t i : block.points) block_of[i] = &block;
      const bool bits = holds_bits(block.table);
      const std::string initial = reads ? std::string() : st::initial_image(block, map_);
      image += fmt::format("    {} : ARRAY [0..{}] OF {}{}{};  {}\n", block.name,
                           bits ? (block.range.count() - 1) / 8 : block.range.count() - 1,
                           bits ? "BYTE" : "WORD", initial.empty() ? "" : " := ", initial,
                           st::comment(place_text(block.table, block.range)));
    }
    std::string members;
    for (const auto& [i, block] : block_of) {
      const Point& point = map_.points[i];
      const modbus::Range place = reads ? read_range(point) : range(point);
      const std::string initial = reads ? std::string() : st::initial_value(point);
      members += fmt::format("    {} : {}{}{};  {}\n", names_[i], st::declared_type(point),
                             initial.empty() ? "" : " := ", initial, remarks(point, place));
      const st::Access access{point, "values." + names_[i], "image." + block->name,
                              static_cast<std::uint32_t>(place.start() - block->range.start()),
                              float_functions_};
      body += reads ? st::decoding(access) : st::encoding(access);
    }
    types_ += fmt::format("TYPE\n  {} : STRUCT\n{}  END_STRUCT;\nEND_TYPE\n\n", side.values_type, members) +
              fmt::format("TYPE\n  {} : STRUCT\n{}  END_STRUCT;\nEND_TYPE\n\n", side.image_type, image);
    // A PLC without types of 64 bits can still use a map without them.
    const auto declared = [&body](std::string_view what, std::string_view declaration) {
      return body.find(what) == std::string::npos ? std::string() : fmt::format("  {}\n", declaration);
    };
    const std::string output =
        declared("not_finite :=",
                 "not_finite : BOOL;  (* a number is NaN or infinite: its variable stays *)") +
        declared("refused :=", "refused : BOOL;  (* a value must not be written: its registers stay *)");
    const std::string locals = declared("FOR i", "i : INT;") + declared("  raw :=", "raw : LREAL;") +
                               declared("bits_32 :=", "bits_32 : DWORD;") +
                               declared("bits_64 :=", "bits_64 : LWORD;");
    blocks_ += fmt::format("FUNCTION_BLOCK {}\nVAR_IN_OUT\n  image : {};\n  values : {};\n{}END_VAR\n",
                           side.function_block, side.image_type, side.values_type, parameters);
    if (!output.empty()) blocks_ += fmt::format("VAR_OUTPUT\n{}END_VAR\n", output);
    if (!locals.empty()) blocks_ += fmt::format("VAR\n{}END_VAR\n", locals);
    blocks_ += declared("not_finite :=", "not_finite := FALSE;") +
               declared("refused :=", "refused := FALSE;") + body + "END_FUNCTION_BLOCK\n\n";
  }

  void constant(const std::string& name, std::string_view type, const std::string& value,
                std::string_view point = {}) {
    constants_ += fmt::format("  {} : {} := {};\n", global(prefix_ + "_" + name, point), type, value);
  }

  void add_way_to_the_coupler() {
    const Connection& connection = map_.connection;
    if (connection.serial.present()) {
      warnings_.add(
          "the coupler is on a serial line, so there is no constant for its host and port",
          fmt::format("use the PLC's client for Modbus RTU, at {}", rate_and_parity(connection.serial)));
      return;
    }
    if (connection.is_rtu())
      warnings_.add("the coupler speaks RTU over TCP",
                    "use a client of the PLC that does, or a gateway that translates");
    if (!connection.address.empty())  // a host name, which has nothing to escape
      constant("host", fmt::format("STRING[{}]", connection.address.size()),
               fmt::format("'{}'", connection.address));
    constant("port", "UINT", fmt::to_string(port_without_tls(map_)));
  }

  void add_constants(const Side& inputs, const Side& outputs) {
    constants_ = "VAR_GLOBAL CONSTANT\n";
    add_way_to_the_coupler();
    constant("unit", "BYTE", fmt::to_string(map_.connection.unit));
    constants_ +=
        "  " +
        st::comment("as a node of OpenCoupler has it: " +
                    place_text(Table::input_registers,
                               modbus::Range::of(identity::reserved.start() + identity::at_fingerprint, 4))) +
        "\n";
    const std::uint64_t print = map_.fingerprint;
    constant("fingerprint", "ARRAY [0..3] OF WORD",
             fmt::format("[16#{:04X}, 16#{:04X}, 16#{:04X}, 16#{:04X}]", print >> 48U, print >> 32U & 0xFFFFU,
                         print >> 16U & 0xFFFFU, print & 0xFFFFU));
    for (const Side* side : {&inputs, &outputs})
      for (const st::Block& block : side->blocks) {
        constants_ += "  " +
                      st::comment(place_text(block.table, block.range) +
                                  (block.rate > 0 ? fmt::format(", at {} Hz", block.rate) : "")) +
                      "\n";
        const std::string name = side->verb + "_" + block.name;
        constant(name + "_function", "BYTE", fmt::to_string(static_cast<unsigned>(block.function)));
        constant(name + "_address", "UINT", fmt::to_string(block.range.start()));
        constant(name + "_quantity", "UINT", fmt::to_string(block.range.count()));
      }
    constants_ += "  (* points *)\n";
    for (std::uint32_t i = 0; i < map_.points.size(); ++i) add_constants(map_.points[i], names_[i]);
    constants_ += "END_VAR\n\n";
  }

  void add_constants(const Point& point, const std::string& name) {
    constant(name + "_address", "UINT", fmt::to_string(point.address), point.name);
    if (range(point).count() > 1)
      constant(name + "_quantity", "UINT", fmt::to_string(range(point).count()), point.name);
    if (point.read_address)
      constant(name + "_read_address", "UINT", fmt::to_string(*point.read_address), point.name);
    for (const NamedValue& named : point.values)
      constant(name + "_" + st::identifier(named.name), to_string(point.format.type),
               fmt::to_string(named.value), point.name);
  }

  static std::string variables_of(const Side& inputs, const Side& outputs) {
    std::string text = "VAR_GLOBAL\n";
    for (const Side* side : {&inputs, &outputs})
      if (!side->blocks.empty())
        text += fmt::format("  {} : {};\n  {} : {};\n", side->values, side->values_type, side->image,
                            side->image_type);
    return text + "END_VAR\n";
  }

  std::string head() const {
    return st::comment(
               fmt::format("The points of the map {}, for a PLC that is the Modbus client.", map_.name)) +
           "\n(* Made by `coupler export --to st`.\n"
           "   Each part of an image is one request: its function, address and quantity are constants "
           "below.\n"
           "   Registers are WORDs as the PLC's Modbus client gives them; coils are 8 to a byte, the first "
           "one lowest.\n"
           "   1. Read into the read image, then call the function block that decodes: the inputs have the "
           "values.\n"
           "   2. Set the outputs, call the function block that encodes, then write the parts of the write "
           "image.\n"
           "   At start the write image has the registers of the values with which the outputs begin. *)\n\n";
  }

  const Map& map_;
  ConversionWarnings& warnings_;
  UniqueNames global_names_;
  UniqueNames member_names_;
  std::string prefix_;
  std::vector<std::string> names_;  ///< of the points
  st::FloatFunctions float_functions_;
  std::string types_, functions_, blocks_, constants_;
};

}  // namespace

Export write_structured_text(const Map& map) {
  Export out;
  out.text = Writer(map, out.warnings).write();
  return out;
}

}  // namespace coupler::formats
