// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/document.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "coupler/map/loader/aliases.hpp"
#include "coupler/map/loader/colon_slip.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/map/loader/syntax_error.hpp"

namespace coupler::loader {
namespace {

/// A ':' follows the key that begins at `at`; without one yaml-cpp takes any text for a key with no value.
bool has_colon(std::string_view text, std::size_t at, std::string_view key) {
  const std::size_t quoted = quoted_end(text, at);
  const std::size_t end = quoted == at ? at + key.size() : quoted;
  const std::size_t next = text.find_first_not_of(" \t\r\n", end);
  return next != std::string_view::npos && text[next] == ':';
}

/// A null that is written out. yaml-cpp's mark of one that is not written is somewhere else.
bool is_null_word(std::string_view text) {
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n,]}"));
  return word == "~" || word == "null" || word == "Null" || word == "NULL";
}

constexpr std::size_t deepest = 16;  // a map needs five

/// Builds the tree from yaml-cpp's events, and checks the text again wherever yaml-cpp lets mistakes pass.
class TreeBuilder : public YAML::EventHandler {
 public:
  /// `anchors`: nullptr where they and aliases are refused.
  TreeBuilder(std::string_view text, bool json, Anchors* anchors)
      : text_(text), end_(position_of(text, text.size())), json_(json), anchors_(anchors) {}

  Entry take() && { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    if (text_.substr(offset(mark), 3) == "---")
      fail(mark, "a second document begins", "keep one map in a file");
    fail(mark, "text after the end of the map", "remove it");
  }
  void OnDocumentEnd() override {}

  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    if (anchors_ == nullptr) fail(mark, fmt::format("anchors are not supported, as '&{}'", name), write_out);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (anchors_ == nullptr) fail(mark, "aliases are not supported", write_out);
    if (awaits_key()) fail(mark, "a key is an alias", "write the key itself");
    const Entry* value = anchors_->find(anchor);
    if (value == nullptr) fail(mark, "the alias stands inside the value that it names", write_out);
    check_depth(mark, depth_of(*value));
    if (!anchors_->make_room_for(*value)) fail_for_size(mark);
    add(*value, false);
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (awaits_key())
      fail(mark, "an entry without a key", "write 'key: value', and a key called null in quotes");
    if (!stack_.empty() && stack_.back().has_key) check_colon(stack_.back());
    Entry entry;
    entry.at = position(mark);
    keep(mark, anchor, entry);
    add(std::move(entry), !is_null_word(text_.substr(std::min(offset(mark), text_.size()))));
  }

  void OnScalar(const YAML::Mark& begin, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const YAML::Mark mark = behind_anchor(begin);
    if (tag != "!" || text_[offset(mark)] == '!') check_tag(mark, tag);  // it is "!" of quoted text, too
    check_text_at(mark, value, tag == "!");
    if (awaits_key()) return set_key(mark, value);
    Entry entry;
    entry.kind = Entry::Kind::scalar;
    entry.at = position(mark);
    entry.text = value;
    entry.quoted = tag == "!";
    keep(mark, anchor, entry);
    add(std::move(entry), false);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(mark, tag, style, Entry::Kind::list);
    stack_.back().anchor = anchor;
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(mark, tag, style, Entry::Kind::map);
    stack_.back().anchor = anchor;
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map that is not complete.
  struct Open {
    Entry entry;
    YAML::Mark mark{};
    YAML::anchor_t anchor = YAML::NullAnchor;
    bool block = false;
    bool has_key = false;  ///< of the value that comes next
    std::string key;
    Position key_at;
    std::size_t key_offset = 0;
  };

  static constexpr const char* write_out = "write the values out where they are used";

  static std::size_t offset(const YAML::Mark& mark) { return static_cast<std::size_t>(mark.pos); }
  /// yaml-cpp may report the newline that was added to the text.
  Position position(const YAML::Mark& mark) const {
    if (offset(mark) >= text_.size()) return end_;
    return {mark.line + 1, mark.column + 1};
  }
  [[noreturn]] void fail(const YAML::Mark& mark, std::string what, std::string remedy) const {
    throw SyntaxError{position(mark), std::move(what), std::move(remedy)};
  }

  [[noreturn]] void fail_for_size(const YAML::Mark& mark) const {
    fail(mark, "aliases of this value make the file too large", write_out);
  }

  /// yaml-cpp's mark of a value behind an anchor in the same line is the anchor's.
  YAML::Mark behind_anchor(YAML::Mark mark) const {
    if (text_.substr(std::min(offset(mark), text_.size()), 1) != "&") return mark;
    const std::size_t name_end = text_.find_first_of(" \t\n", offset(mark));
    const std::size_t value = text_.find_first_not_of(" \t", name_end);
    if (value == std::string_view::npos || text_[value] == '\n') return mark;
    const int step = static_cast<int>(value - offset(mark));
    mark.pos += step;
    mark.column += step;
    return mark;
  }

  void keep(const YAML::Mark& mark, YAML::anchor_t anchor, const Entry& value) {
    if (anchor != YAML::NullAnchor && anchors_ != nullptr && !anchors_->keep(anchor, value))
      fail_for_size(mark);
  }

  bool awaits_key() const {
    return !stack_.empty() && stack_.back().entry.kind == Entry::Kind::map && !stack_.back().has_key;
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?") fail(mark, "tags are not supported", "remove the '!' and its name");
  }

  void check_text_at(const YAML::Mark& mark, const std::string& value, bool quoted) const {
    if (quoted_end(text_, offset(mark)) == std::string_view::npos)
      fail(mark, "the quote is never closed", "close it where the text ends");
    if (quoted || !json_) return;
    // In JSON bare words and numbers hold no blanks, but yaml-cpp reads `"b": 2 "c"` as the text `2 "c"`.
    if (const std::size_t blank = value.find_first_of(" \t\n"); blank != std::string::npos)
      throw SyntaxError{position_of(text_, offset(mark) + blank), "',' is missing here",
                        "separate entries with ','; put text that contains blanks in quotes"};
  }

  void check_colon(const Open& map) const {
    if (has_colon(text_, map.key_offset, map.key)) return;
    auto slip = json_ ? std::nullopt : colon_slip(map.key);
    if (!slip && !json_) slip = slip_before_bracket(map.key, map.key_offset);
    if (slip) throw SyntaxError{map.key_at, slip->what, slip->remedy()};
    const std::string_view in_brackets = "; put text that contains ',' in quotes";
    throw SyntaxError{map.key_at, fmt::format("':' is missing after {}", shown(map.key)),
                      fmt::format("write 'key: value', with a blank after the ':'{}",
                                  map.block || json_ ? "" : in_brackets)};
  }

  /// 'lamp {address: 1}', of which yaml-cpp takes 'lamp {address' or 'lamp' for the key.
  std::optional<ColonSlip> slip_before_bracket(std::string_view key, std::size_t at) const {
    const std::string_view line = text_.substr(at, std::min(text_.find('\n', at), text_.size()) - at);
    const std::size_t bracket = line.find_first_of("{[");
    if (bracket > line.find_first_not_of(" \t", key.size()) &&
        key.find_first_of("{[") == std::string_view::npos)
      return std::nullopt;
    return colon_slip(line);
  }

  void set_key(const YAML::Mark& mark, const std::string& key) {
    if (key == "<<" && anchors_ == nullptr)
      fail(mark, "merge keys ('<<') are not supported", "write the keys out");
    Open& map = stack_.back();
    const bool is_bare = quoted_end(text_, offset(mark)) == offset(mark);
    if (map.block && is_bare && key.find_first_of("{[") != std::string::npos)
      if (const auto slip = slip_before_bracket(key, offset(mark)))
        throw SyntaxError{position(mark), slip->what, slip->remedy()};
    map.has_key = true;
    map.key = key;
    map.key_at = position(mark);
    map.key_offset = offset(mark);
  }

  void check_depth(const YAML::Mark& mark, std::size_t more) const {
    if (stack_.size() + more > deepest)
      fail(mark, "the values are nested too deep", "a map has at most five levels");
  }

  void open(const YAML::Mark& begin, const std::string& tag, YAML::EmitterStyle::value style,
            Entry::Kind kind) {
    const YAML::Mark mark = behind_anchor(begin);
    check_tag(mark, tag);
    if (awaits_key()) fail(mark, "a key is not text", "write 'key: value'");
    check_depth(mark, 1);
    Open opened;
    opened.mark = mark;
    opened.block = style == YAML::EmitterStyle::Block;
    opened.entry.kind = kind;
    opened.entry.at = position(mark);
    stack_.push_back(std::move(opened));
  }

  void close() {
    Open closed = std::move(stack_.back());
    stack_.pop_back();
    if (anchors_ != nullptr) merge_keys(closed.entry);
    keep(closed.mark, closed.anchor, closed.entry);
    add(std::move(closed.entry), closed.block);
  }

  /// `placeless`: nothing, or a block; yaml-cpp's mark is then somewhere behind the key.
  void add(Entry entry, bool placeless) {
    if (stack_.empty()) {
      root_ = std::move(entry);
      return;
    }
    Open& parent = stack_.back();
    if (parent.has_key) {
      entry.key = std::move(parent.key);
      entry.key_at = parent.key_at;
      if (placeless) entry.at = entry.key_at;
      parent.has_key = false;
    }
    parent.entry.children.push_back(std::move(entry));
  }

  std::string_view text_;
  Position end_;
  bool json_;
  Anchors* anchors_;
  int documents_ = 0;
  std::vector<Open> stack_;
  Entry root_;
};

/// With a newline at the end yaml-cpp reports an open quote's beginning to the builder instead of stopping.
Entry build_tree(const std::string& text, bool json, Anchors* anchors) {
  std::string yaml = text + '\n';
  indent_with_blanks(yaml);
  std::istringstream in(yaml);
  TreeBuilder builder(text, json, anchors);
  try {
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder))
      throw SyntaxError{{1, 1}, "the file is empty", "describe a device in it"};
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& e) {
    const std::size_t at = e.mark.pos < 0 ? 0 : static_cast<std::size_t>(e.mark.pos);
    if (anchors != nullptr && e.msg.find("anchor is not defined") != std::string::npos)
      throw SyntaxError{position_of(text, at), "no anchor of that name stands before the alias",
                        "put '&' and the name before the value that it stands for"};
    throw explain(text, at, e.msg);
  }
  return std::move(builder).take();
}

}  // namespace

const Entry* child(const Entry& entry, std::string_view key) {
  const auto found = std::find_if(entry.children.begin(), entry.children.end(),
                                  [&](const Entry& e) { return e.key == key; });
  return found == entry.children.end() ? nullptr : &*found;
}

std::optional<Entry> parse_document(std::string_view text, Problems& problems, Aliases aliases) {
  text = without_byte_order_mark(text);
  if (!check_text(text, problems) || !check_shape(text, problems)) return std::nullopt;
  std::string source(text);
  const bool json = is_json(source);
  if (json && !blank_comments(source, problems)) return std::nullopt;
  Anchors anchors;
  try {
    return build_tree(source, json, aliases == Aliases::read ? &anchors : nullptr);
  } catch (const SyntaxError& e) {
    problems.error(e.at, e.what, e.remedy);
    return std::nullopt;
  }
}

}  // namespace coupler::loader
