// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/drawing.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "coupler/codec/bit_string.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/docs/point_description.hpp"

namespace coupler::docs {
namespace {

using codec::Format;
using codec::Type;

using Cell = Drawing::Cell;
using Register = Drawing::Register;
using Registers = std::array<std::uint16_t, 4>;

constexpr std::size_t most_characters = 4;

/// A value whose bytes all differ.
codec::Value example_value(Type type) {
  if (type == Type::REAL) return 123.456F;
  if (type == Type::LREAL) return 123.456;
  constexpr std::uint64_t digits = 0x123456789ABCDEF0;
  return digits >> (64 - codec::width(type));
}

/// The same place in registers, without a sign or a point.
Format as_bits(Format format) {
  constexpr std::array types{Type::WORD, Type::DWORD, Type::LWORD};
  for (const Type type : types)
    if (codec::width(type) == codec::width(format.type)) format.type = type;
  return format;
}

Registers encoded(const codec::Value& value, const Format& format) {
  Registers registers{};
  [[maybe_unused]] const auto held = codec::encode(value, format, registers.data());
  return registers;
}

std::array<std::uint8_t, 2> bytes_of(std::uint16_t word) {
  return {static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word & 0xFF)};
}

/// "ABCD": where the bytes of a value go is what the codec does with these letters.
codec::Value letters(unsigned bytes) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < bytes; ++i) value = value << 8 | ('A' + i);
  return value;
}

Drawing draw_number(const Point& point) {
  const Format format = point.format;
  const unsigned bytes = codec::width(format.type) / 8;
  const codec::Value value = example_value(format.type);
  const Registers values = encoded(value, format);
  const Registers names = encoded(letters(bytes), as_bits(format));
  const auto bits = codec::decode(values.data(), as_bits(format));

  Drawing drawing;
  drawing.title =
      fmt::format("{}: {}, order {}", point.name, to_string(format.type), codec::order_text(format));
  const std::string written = codec::text_of(value, format.type);
  const std::string hexadecimal = codec::text_of(bits, as_bits(format).type);
  drawing.explanation =
      written == hexadecimal
          ? fmt::format("The value is {}", written)
          : fmt::format("The {}value {} is {}", point.scale.present() ? "raw " : "", written, hexadecimal);
  drawing.explanation +=
      fmt::format("; A is its most significant byte, {} its least.", static_cast<char>('A' + bytes - 1));
  for (std::uint32_t i = 0; i < codec::registers(format); ++i) {
    Register drawn{range(point).start() + i, {}};
    for (const std::size_t half : {0U, 1U})
      drawn.cells.push_back({std::string(1, static_cast<char>(bytes_of(names[i])[half])),
                             fmt::format("{:02X}", bytes_of(values[i])[half])});
    drawing.registers.push_back(std::move(drawn));
  }
  return drawing;
}

Drawing draw_text(const Point& point) {
  constexpr std::string_view text = "FLOW";
  Format format = point.format;
  format.length = static_cast<std::uint16_t>(std::min<std::size_t>(format.length, most_characters));
  const std::string shown(text.substr(0, format.length));
  const Registers values = encoded(shown, format);

  Drawing drawing;
  drawing.title = fmt::format("{}: STRING, {}", point.name,
                              codec::ignores_byte_order(format) ? "first character in the high byte"
                                                                : "first character in the low byte");
  drawing.explanation = fmt::format("The text \"{}\"; 1 is its first character.", shown);
  for (std::uint32_t i = 0; i < codec::registers(format); ++i) {
    Register drawn{range(point).start() + i, {}};
    for (const std::uint8_t byte : bytes_of(values[i])) {
      const std::size_t at = byte == 0 ? std::string::npos : shown.find_first_of(static_cast<char>(byte));
      drawn.cells.push_back({at == std::string::npos ? "" : fmt::to_string(at + 1),
                             at == std::string::npos ? "00" : std::string(1, shown[at]),
                             at != std::string::npos});
    }
    drawing.registers.push_back(std::move(drawn));
  }
  return drawing;
}

/// Its place is drawn as bits, not as a byte.
bool has_bit_cells(const Point& point) { return codec::field_bits(point.format) != 0; }

/// Returns the points of one kind that share the register of `first`, with the first bit or byte on the left.
std::vector<const Point*> neighbours(const Map& map, const Point& first) {
  std::vector<const Point*> found;
  for (const Point& point : map.points)
    if (point.table == first.table && point.address == first.address && is_partial(point) &&
        point.format.order == first.format.order && has_bit_cells(point) == has_bit_cells(first))
      found.push_back(&point);
  std::sort(found.begin(), found.end(), [](const Point* a, const Point* b) {
    return std::tuple(codec::mask(b->format), a->name) < std::tuple(codec::mask(a->format), b->name);
  });
  return found;
}

/// Numbered as the map numbers them: behind the swap of the two bytes.
std::vector<Cell> bit_cells(std::uint16_t word, std::uint16_t used, bool swapped) {
  std::vector<Cell> cells;
  for (unsigned at = 16; at-- > 0;) {
    const unsigned number = swapped ? at ^ 8U : at;
    cells.push_back({fmt::to_string(number), fmt::to_string(word >> at & 1), (used >> at & 1) != 0});
  }
  return cells;
}

std::vector<Cell> byte_cells(std::uint16_t word, std::uint16_t used, bool swapped) {
  const auto bytes = bytes_of(word);
  const auto of_points = bytes_of(used);
  return {{swapped ? "low" : "high", fmt::format("{:02X}", bytes[0]), of_points[0] != 0},
          {swapped ? "high" : "low", fmt::format("{:02X}", bytes[1]), of_points[1] != 0}};
}

/// The bits or bytes of one register, of which only those of `first` are set.
Drawing draw_parts(const Map& map, const Point& first) {
  std::uint16_t used = 0;
  std::string list;
  for (const Point* point : neighbours(map, first)) {
    used = static_cast<std::uint16_t>(used | codec::mask(point->format));
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", describe(*point, 0).part, point->name);
  }
  const std::uint16_t mask = codec::mask(first.format);
  const bool swapped = codec::bytes_swapped(first.format.order);
  const auto order = codec::order_text(first.format);
  if (has_bit_cells(first)) {
    const std::string set =
        first.format.type == Type::BOOL ? "on" : fmt::to_string(codec::largest_in(first.format.bits));
    return {fmt::format("Bits of a register, order {}", order),
            fmt::format("The register is 0x{:04X} when {} is {} and nothing else is. In it: {}.", mask,
                        first.name, set, list),
            {{first.address, bit_cells(mask, used, swapped)}}};
  }
  const auto word = static_cast<std::uint16_t>(mask & 0x1212);
  return {fmt::format("Bytes of a register, order {}", order),
          fmt::format("The register is 0x{:04X} when {} is 0x12. In it: {}.", word, first.name, list),
          {{first.address, byte_cells(word, used, swapped)}}};
}

constexpr int letter_width = 8;

/// Wide enough for "high", and for the numbers of bits.
std::size_t cell_width(const Drawing& drawing) { return drawing.registers.front().cells.size() > 2 ? 4 : 8; }

}  // namespace

std::vector<Drawing> drawings_of(const Map& map) {
  std::vector<Drawing> drawings;
  std::set<std::tuple<codec::Order, unsigned>> seen;  // order and width; that of a STRING is 0, of bits 1
  for (const Point& point : map.points) {
    const unsigned width = has_bit_cells(point) ? 1 : codec::width(point.format.type);
    if (holds_bits(point.table) || !seen.emplace(point.format.order, width).second) continue;
    if (point.format.type == Type::STRING)
      drawings.push_back(draw_text(point));
    else
      drawings.push_back(is_partial(point) ? draw_parts(map, point) : draw_number(point));
  }
  return drawings;
}

std::string as_text(const Drawing& drawing) {
  const std::size_t width = cell_width(drawing);
  std::array<std::string, 4> lines;  // addresses, labels, contents, edges
  const std::array<std::string_view, 4> heads{"register  ", "which     ", "holds     ", "          "};
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = heads[i];
  for (const Register& drawn : drawing.registers) {
    lines[0] += fmt::format("{:^{}}  ", drawn.address, width * drawn.cells.size() + 1);
    for (const Cell& cell : drawn.cells) {
      lines[1] += fmt::format("|{:^{}}", cell.label, width - 1);
      lines[2] += fmt::format("|{:^{}}", cell.content, width - 1);
      lines[3] += fmt::format("+{:-^{}}", "", width - 1);
    }
    lines[1] += "|  ";
    lines[2] += "|  ";
    lines[3] += "+  ";
  }
  std::string text;
  for (const std::size_t line : {0U, 3U, 1U, 2U, 3U}) {
    text += lines[line];
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string as_svg(const Drawing& drawing) {
  constexpr int top = 20;
  constexpr int height = 48;
  constexpr int gap = 12;
  const int width = static_cast<int>(cell_width(drawing)) * letter_width;
  std::string shapes;
  std::string described;
  int x = 1;
  for (const Register& drawn : drawing.registers) {
    const int all = width * static_cast<int>(drawn.cells.size());
    shapes += fmt::format("<text class=\"address\" x=\"{}\" y=\"13\">register {}</text>\n", x + all / 2,
                          drawn.address);
    described += fmt::format("{}register {}:", described.empty() ? "" : "; ", drawn.address);
    for (const Cell& cell : drawn.cells) {
      shapes += fmt::format(
          "<rect{0} x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\"/><text class=\"label\" x=\"{5}\" "
          "y=\"{6}\">{7}</text>"
          "<text x=\"{5}\" y=\"{8}\">{9}</text>\n",
          cell.is_used ? " class=\"used\"" : "", x, top, width, height, x + width / 2, top + 19, cell.label,
          top + 39, cell.content);
      described += fmt::format(" {} {}", cell.label, cell.content);
      x += width;
    }
    x += gap;
  }
  const int full = x - gap + 1;
  return fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\">\n{3}</svg>\n",
      full, top + height + 1, described, shapes);
}

}  // namespace coupler::docs
