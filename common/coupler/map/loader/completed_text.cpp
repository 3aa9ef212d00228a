// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/placement.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {
namespace {

/// Replaces `size` bytes at `at`.
struct Edit {
  std::size_t at;
  std::size_t size;
  std::string text;
};

class Editor {
 public:
  Editor(std::string_view text, Addressing addressing)
      : bare_(text), json_(is_json(text)), addressing_(addressing) {
    Problems none("");
    if (json_) blank_comments(bare_, none);
    lines_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') lines_.push_back(i + 1);
  }

  Edit address_edit(const DraftPoint& draft) const {
    const Entry& entry = *draft.entry;
    if (entry.kind == Entry::Kind::null) return replace_nothing(draft);
    const bool flow = bare_[offset(entry.at)] == '{' && !is_key(entry);
    if (flow) return {offset(entry.at) + 1, 0, keys(draft, ", ", !entry.children.empty())};
    // A block begins where its first key does, or at the '?' that may stand before that.
    const std::size_t key = offset(entry.children.front().key_at);
    const std::size_t before = bare_.find_last_not_of(" \t", key - 1);
    const std::size_t at = bare_[before] == '?' ? before : key;
    const std::size_t line = bare_.rfind('\n', at) + 1;
    return {at, 0, keys(draft, '\n' + std::string(at - line, ' '), true)};
  }

  /// Nothing to do: the name is IEC 61131-3's, or it is written in a way that hides it, as behind '|'.
  std::optional<Edit> type_edit(const DraftPoint& draft) const {
    const Entry* type = child(*draft.entry, "type");
    if (type == nullptr || codec::is_iec_name(type->text)) return std::nullopt;
    const auto line = static_cast<std::size_t>(type->at.line);
    if (line < 1 || line > lines_.size()) return std::nullopt;
    const std::size_t at = offset(type->at) + (type->quoted ? 1 : 0);
    if (std::string_view(bare_).substr(std::min(at, bare_.size()), type->text.size()) != type->text)
      return std::nullopt;
    return Edit{at, type->text.size(), std::string(to_string(draft.point.format.type))};
  }

 private:
  static bool is_key(const Entry& entry) {
    return entry.at.line == entry.key_at.line && entry.at.column == entry.key_at.column;
  }

  std::size_t offset(Position at) const {
    return lines_[static_cast<std::size_t>(at.line - 1)] + static_cast<std::size_t>(at.column - 1);
  }

  std::string address(const DraftPoint& draft) const {
    return address_text(draft.point.address, draft.point.table, addressing_);
  }

  std::string key(std::string_view name, std::string_view value) const {
    return json_ ? fmt::format("\"{}\": {}", name, value) : fmt::format("{}: {}", name, value);
  }

  std::string keys(const DraftPoint& draft, const std::string& separator, bool more) const {
    const codec::Format& format = draft.point.format;
    std::string text = key("address", address(draft));
    if (is_partial(draft.point) && !draft.part_given) {
      const std::string_view half = format.half == codec::Half::high ? "high" : "low";
      const std::string quoted = json_ ? fmt::format("\"{}\"", half) : std::string(half);
      text += separator;
      text +=
          format.type == codec::Type::BOOL ? key("bit", fmt::to_string(format.bit)) : key("offset", quoted);
    }
    return more ? text + separator : text;
  }

  /// `valve:` or `valve: ~` becomes `valve: 7`.
  Edit replace_nothing(const DraftPoint& draft) const {
    const Entry& entry = *draft.entry;
    if (!is_key(entry)) {
      const std::size_t at = offset(entry.at);
      return {at, std::size_t{bare_[at] == '~' ? 1U : 4U}, address(draft)};
    }
    const std::size_t start = offset(entry.key_at);
    const std::size_t quoted = quoted_end(bare_, start);
    const std::size_t end = quoted == start ? start + entry.key.size() : quoted;
    return {bare_.find(':', end) + 1, 0, ' ' + address(draft)};
  }

  std::string bare_;  ///< the text without comments of JSON, at the same places
  bool json_;
  Addressing addressing_;
  std::vector<std::size_t> lines_;  ///< where they begin
};

}  // namespace

std::string completed_text(std::string_view text, const DraftPoints& points, Addressing addressing) {
  const std::string_view whole = text;
  text = without_byte_order_mark(text);
  const Editor editor(text, addressing);
  std::vector<Edit> edits;
  for (const DraftPoint& draft : points) {
    if (draft.addressless) edits.push_back(editor.address_edit(draft));
    if (auto edit = editor.type_edit(draft)) edits.push_back(std::move(*edit));
  }
  if (edits.empty()) return std::string(whole);
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at < b.at; });
  std::string result;
  std::size_t from = 0;
  for (const Edit& edit : edits) {
    result.append(text.substr(from, edit.at - from)).append(edit.text);
    from = edit.at + edit.size;
  }
  return result.append(text.substr(from));
}

}  // namespace coupler::loader
