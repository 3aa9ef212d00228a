// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/modbus/range.hpp"

namespace coupler::plan {

/// A rectangle in pixels.
struct Box {
  double x, y, width, height;

  Box inset(double by) const { return {x + by, y + by, width - 2 * by, height - 2 * by}; }
  /// The `i`-th of `count` columns of it.
  Box part(std::size_t i, std::size_t count) const {
    const double w = width / static_cast<double>(count);
    return {x + w * static_cast<double>(i), y, w, height};
  }
};

/// How large things are: few addresses wide enough for names, many narrow.
struct Scale {
  std::uint32_t columns;  ///< addresses in a row
  double cell;            ///< width of one, px
  double height;          ///< of a row, px
  bool names;
};
constexpr Scale large{16, 64, 30, true};
constexpr Scale small{64, 16, 16, false};

/// The layout of the addresses of one table: rows of `columns` each, without those in which everything is
/// left out.
class TableLayout {
 public:
  static constexpr double left = 110;  ///< room for the addresses of the rows
  static constexpr double skip = 14;   ///< height of what stands for rows left out

  /// `shown`: what must be visible.
  TableLayout(const std::vector<modbus::Range>& shown, Scale scale, double top);

  /// One box a row, left to right and downward; rows that are left out have none.
  std::vector<Box> boxes(modbus::Range range) const;

  struct Row {
    std::uint32_t first;  ///< address
    double y;
    bool after_skip;  ///< rows before it were left out
  };
  const std::vector<Row>& rows() const { return rows_; }
  double bottom() const { return bottom_; }
  const Scale& scale() const { return scale_; }

 private:
  Scale scale_;
  std::vector<Row> rows_;
  double bottom_;
};

}  // namespace coupler::plan
