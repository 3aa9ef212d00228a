// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "coupler/codec/text.hpp"
#include "coupler/test_vectors/elements.hpp"

namespace coupler::test_vectors {
namespace {

using codec::Encoding;

std::string alphabet(std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) text += static_cast<char>('A' + i % 26);
  return text;
}

std::string repeated(std::string_view character, std::size_t count) {
  std::string text;
  while (count-- > 0) text += character;
  return text;
}

/// Those that do not fit are left out.
std::vector<std::string> texts(const codec::Format& format) {
  const std::size_t length = format.length;
  std::vector<std::string> some{"", "A", "Ab1", alphabet(length - 1), alphabet(length)};
  switch (format.encoding) {
    case Encoding::utf8:
      some.insert(some.end(), {"é", "Größe 7 µm", "€ 𝄞", repeated("ü", length / 2) + alphabet(length % 2)});
      break;
    case Encoding::latin1: some.insert(some.end(), {"é", "Größe 7 µm", repeated("ÿ", length)}); break;
    case Encoding::ascii: some.push_back(repeated("~", length)); break;
  }
  return some;
}

}  // namespace

std::vector<Element> text_elements(const codec::Format& format) {
  std::vector<Element> elements;
  const auto add = [&](std::string_view text, const codec::Format& as) {
    Element element(codec::registers(format));
    if (codec::encode_text(text, as, element.data()) == codec::TextError::none) elements.push_back(element);
  };
  for (const std::string& text : texts(format)) add(text, format);
  codec::Format bytes = format;  // Latin-1 has all of them, each as itself
  bytes.encoding = Encoding::latin1;
  add(std::string_view("a\0z", 3), bytes);
  if (format.encoding == Encoding::ascii) add("é", bytes);
  return elements;
}

std::vector<codec::Value> refused_texts(const codec::Format& format) {
  std::vector<codec::Value> refused{alphabet(format.length + 1U)};
  switch (format.encoding) {
    case Encoding::utf8: refused.emplace_back(alphabet(format.length - 1U) + "é"); break;
    case Encoding::latin1: refused.emplace_back("€"); break;
    case Encoding::ascii: refused.emplace_back("é"); break;
  }
  return refused;
}

}  // namespace coupler::test_vectors
