// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/picture.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "coupler/map/escape.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/picture_layout.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::plan {
namespace {

using modbus::Range;

constexpr double margin = 16;
constexpr double width = TableLayout::left + large.columns * large.cell + margin;
constexpr double letter = 6.1;  ///< width of one, about
/// Rates: a colour each, dark enough for white names; then again from the first.
constexpr std::array<std::string_view, 6> colours{"#0072b2", "#b85c00", "#00795a",
                                                  "#a8457f", "#7a5c1e", "#4b4f9e"};

/// In an HTML page a style holds for the whole page: everything is below the class of the image.
constexpr std::string_view style = R"(
.coupler-plan text { font: 11px sans-serif; fill: #222 }
.coupler-plan .map { font-size: 15px; font-weight: bold }
.coupler-plan .table { font-size: 13px; font-weight: bold }
.coupler-plan .address { fill: #666; text-anchor: end }
.coupler-plan .column { fill: #999; font-size: 9px; text-anchor: middle }
.coupler-plan .name { fill: #fff; font-size: 10px; text-anchor: middle }
.coupler-plan .name.unread { fill: #444 }
.coupler-plan .none { fill: #666 }
.coupler-plan .row { fill: #f3f3f3 }
.coupler-plan .request { fill-opacity: .18; stroke-width: 1.5 }
.coupler-plan .point { stroke: #fff; stroke-width: .7 }
.coupler-plan .unread-point { fill: #fff; stroke: #666; stroke-dasharray: 3 2 }
.coupler-plan .paper { fill: #fff }
.coupler-plan .hole { fill: url(#coupler-plan-hole) }
.coupler-plan .unreadable { fill: url(#coupler-plan-unreadable) }
)";

constexpr std::string_view patterns = R"(<defs>
<pattern id="coupler-plan-hole" width="6" height="6" patternUnits="userSpaceOnUse">
<path d="M0 6L6 0" stroke="#777" stroke-width=".8"/></pattern>
<pattern id="coupler-plan-unreadable" width="6" height="6" patternUnits="userSpaceOnUse">
<path d="M0 0L6 6M0 6L6 0" stroke="#c1121f" stroke-width="1"/></pattern>
</defs>
)";

std::string heading(Table table) {
  std::string text(to_string(table));
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

class Picture {
 public:
  Picture(const Map& map, const std::vector<GroupPlan>& plan, const PictureOptions& options)
      : map_(map), plan_(plan), options_(options) {
    std::size_t rows = 0;
    for (const Table table : tables) rows += TableLayout(shown(table), large, 0).rows().size();
    scale_ = rows <= 40 ? large : small;
  }

  std::string draw() {
    y_ = margin + 14;
    text(margin, y_, "map", fmt::format("{}: {} points, {}", map_.name, map_.points.size(), requests()));
    y_ += 12;
    legend();
    for (const Table table : tables) draw(table);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
        "height=\"{1:g}\" "
        "role=\"img\" class=\"coupler-plan\">\n<title>{2}: how it is read</title>\n<style>{3}</style>\n{4}"
        "<rect width=\"100%\" height=\"100%\" class=\"paper\"/>\n{5}</svg>\n",
        width, y_ + margin, html(map_.name), style, patterns, out_);
  }

 private:
  std::string requests() const {
    std::size_t count = 0;
    for (const GroupPlan& group : plan_) count += group.spans.size();
    return fmt::format("{} request{}", count, count == 1 ? "" : "s");
  }

  /// Returns where a point is drawn: at the place where it is read, if it is read.
  static Range place(const Point& point) { return is_readable(point) ? read_range(point) : range(point); }

  std::vector<Range> shown(Table table) const {
    std::vector<Range> result;
    for (const Point& point : map_.points)
      if (point.table == table) result.push_back(place(point));
    for (const GroupPlan& group : plan_)
      for (const ReadSpan& span : group.spans)
        if (span.table == table) result.push_back(span.range);
    return result;
  }

  void draw(Table table) {
    const auto ranges = shown(table);
    if (ranges.empty() && !options_.every_table) return;
    y_ += 34;
    text(margin, y_, "table", heading(table));
    if (ranges.empty()) {
      text(TableLayout::left, y_, "none", "no points");
      return;
    }
    const TableLayout layout(ranges, scale_, y_ + 18);
    for (std::uint32_t i = 0; i < scale_.columns; i += scale_.names ? 1 : 8)
      text(TableLayout::left + scale_.cell * (i + 0.5), y_ + 13, "column", fmt::format("+{}", i));
    for (const auto& row : layout.rows()) {
      if (row.after_skip) text(TableLayout::left - 24, row.y - 4, "address", "⋮");
      box({TableLayout::left, row.y + 1, scale_.cell * scale_.columns, scale_.height - 2}, "row", "", "");
      text(TableLayout::left - 8, row.y + scale_.height / 2 + 4, "address",
           fmt::format("{} · {}", row.first, modicon(table, row.first)));
    }
    for (const TableRange& area : map_.unreadable)
      if (area.table == table)
        boxes(layout, area.range, "unreadable", "",
              fmt::format("unreadable: {} to {}", area.range.start(), area.range.last()));
    for (std::size_t i = 0; i < plan_.size(); ++i)
      for (const ReadSpan& span : plan_[i].spans)
        if (span.table == table) draw(layout, span, i);
    draw_points(table, layout);
    y_ = layout.bottom();
  }

  void draw(const TableLayout& layout, const ReadSpan& span, std::size_t group) {
    const auto title = fmt::format("request: {} {} to {} ({} points) at {:g} Hz; ends: {}",
                                   heading(span.table), span.range.start(), span.range.last(),
                                   span.points.size(), plan_[group].rate, explain_end(span, map_));
    const std::string_view colour = colours[group % colours.size()];
    boxes(layout, span.range, "request", fmt::format(" fill=\"{0}\" stroke=\"{0}\"", colour), title);
    for (const Range hole : holes(span, map_))
      boxes(layout, hole, "hole", "", fmt::format("{} to {}: read, for no point", hole.start(), hole.last()));
  }

  /// Points in the same place (bits of a register) stand side by side in it.
  void draw_points(Table table, const TableLayout& layout) {
    std::vector<const Point*> points;
    for (const Point& point : map_.points)
      if (point.table == table) points.push_back(&point);
    const auto before = [](const Point* a, const Point* b) {
      const Range x = place(*a);
      const Range y = place(*b);
      return x.start() != y.start() ? x.start() < y.start() : x.end() > y.end();
    };
    std::stable_sort(points.begin(), points.end(), before);
    for (auto first = points.begin(); first != points.end();) {
      const auto last = std::find_if(first, points.end(),
                                     [&](const Point* other) { return place(*other) != place(**first); });
      const auto count = static_cast<std::size_t>(last - first);
      for (std::size_t i = 0; i < count; ++i)
        draw(layout, **std::next(first, static_cast<std::ptrdiff_t>(i)), i, count);
      first = last;
    }
  }

  void draw(const TableLayout& layout, const Point& point, std::size_t i, std::size_t count) {
    const bool read = !why_not_read(map_, point);
    const Range place_of = place(point);
    const auto group =
        std::find_if(plan_.begin(), plan_.end(),
                     [rate = rate_of(map_, point)](const GroupPlan& g) { return g.rate == rate; });
    const auto colour = colours[static_cast<std::size_t>(group - plan_.begin()) % colours.size()];
    const auto title = fmt::format(
        "{}: {}{}, {} to {}{}{}", point.name, codec::to_string(point.format.type),
        point.count > 1 ? fmt::format(" × {}", point.count) : "", place_of.start(), place_of.last(),
        read ? fmt::format(", {:g} Hz", rate_of(map_, point))
             : fmt::format(", not read: {}", to_string(*why_not_read(map_, point))),
        point.description.empty() ? "" : fmt::format("; {}", point.description));
    if (!options_.link.empty()) out_ += fmt::format("<a href=\"{}{}\">\n", html(options_.link), point.name);
    bool named = false;
    for (const Box& whole : layout.boxes(place_of)) {
      const Box cell = whole.inset(scale_.names ? 4 : 2.5).part(i, count);
      box(cell, read ? "point" : "unread-point", read ? fmt::format(" fill=\"{}\"", colour) : "", title);
      const auto fitting = static_cast<std::size_t>(std::max(0.0, (cell.width - 4) / letter));
      if (scale_.names && !named && fitting >= 2)
        text(cell.x + cell.width / 2, cell.y + cell.height / 2 + 4, read ? "name" : "name unread",
             point.name.size() <= fitting ? std::string(point.name)
                                          : std::string(point.name.substr(0, fitting - 1)) + "…");
      named = true;
    }
    if (!options_.link.empty()) out_ += "</a>\n";
  }

  void legend() {
    double x = margin;
    const auto entry = [&](std::string_view css, const std::string& attributes, const std::string& what) {
      box({x, y_, 14, 12}, css, attributes, "");
      text(x + 19, y_ + 10, "", what);
      x += 34 + letter * static_cast<double>(what.size());
    };
    for (std::size_t i = 0; i < plan_.size(); ++i)
      entry("point", fmt::format(" fill=\"{}\"", colours[i % colours.size()]),
            fmt::format("{:g} Hz", plan_[i].rate));
    entry("request", " fill=\"#444\" stroke=\"#444\"", "one request");
    entry("hole", "", "read, for no point");
    entry("unread-point", "", "not read");
    if (!map_.unreadable.empty()) entry("unreadable", "", "unreadable");
    y_ += 12;
  }

  void boxes(const TableLayout& layout, Range range, std::string_view css, const std::string& attributes,
             const std::string& title) {
    for (const Box& each : layout.boxes(range)) box(each.inset(1), css, attributes, title);
  }

  void box(const Box& b, std::string_view css, const std::string& attributes, const std::string& title) {
    out_ += fmt::format("<rect x=\"{:.4g}\" y=\"{:.6g}\" width=\"{:.4g}\" height=\"{:.4g}\" class=\"{}\"{}",
                        b.x, b.y, b.width, b.height, css, attributes);
    out_ += title.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", html(title));
  }

  void text(double x, double y, std::string_view css, const std::string& what) {
    out_ += fmt::format("<text x=\"{:.5g}\" y=\"{:.6g}\" class=\"{}\">{}</text>\n", x, y, css, html(what));
  }

  const Map& map_;
  const std::vector<GroupPlan>& plan_;
  const PictureOptions& options_;
  Scale scale_ = large;
  double y_ = 0;
  std::string out_;
};

}  // namespace

std::string picture(const Map& map, const std::vector<GroupPlan>& plan, const PictureOptions& options) {
  return Picture(map, plan, options).draw();
}

}  // namespace coupler::plan
