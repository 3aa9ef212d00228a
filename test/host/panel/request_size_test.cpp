// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/request_size.hpp"

#include <gtest/gtest.h>

#include <string>

namespace coupler::host {
namespace {

std::size_t size_of(const std::string& text) { return request_size(text, 0, 4096); }

TEST(RequestSize, Without_a_body_it_ends_with_an_empty_line) {
  const std::string get = "GET /points.json HTTP/1.1\r\nHost: 10.0.0.7:8502\r\n\r\n";
  EXPECT_EQ(size_of(get), get.size());
  EXPECT_EQ(size_of(get + "GET /"), get.size());
  for (std::size_t size = 0; size < get.size(); ++size) {
    EXPECT_EQ(size_of(get.substr(0, size)), unknown_size) << size;
    EXPECT_EQ(request_size(get, size, 4096), get.size()) << "what came first has no end: " << size;
  }
}

TEST(RequestSize, Has_the_body_that_its_header_announces) {
  for (const char* const line : {"Content-Length: 5", "content-length:5", "CONTENT-LENGTH: \t5"}) {
    const std::string header = std::string("POST /write HTTP/1.1\r\nHost: a\r\n") + line + "\r\nB: c\r\n\r\n";
    EXPECT_EQ(size_of(header), header.size() + 5) << line;
    EXPECT_EQ(size_of(header + "12345"), header.size() + 5) << line;
  }
}

TEST(RequestSize, A_line_that_only_looks_like_a_length_is_none) {
  for (const char* const line :
       {"X-Content-Length: 5", "Content-Lengths: 5", "A: Content-Length: 5", "Content-Length:"}) {
    const std::string header = std::string("GET / HTTP/1.1\r\n") + line + "\r\n\r\n";
    EXPECT_EQ(size_of(header), header.size()) << line;
  }
}

TEST(RequestSize, A_body_that_is_refused_is_not_counted) {
  const auto with = [](const std::string& line) { return "POST / HTTP/1.1\r\n" + line + "\r\n\r\n"; };
  EXPECT_EQ(size_of(with("Content-Length: 4096")), with("Content-Length: 4096").size() + 4096);
  for (const std::string line : {"Content-Length: 4097", "Content-Length: 18446744073709551616",
                                 "Content-Length: -1", "Content-Length: x", "Transfer-Encoding: chunked"})
    EXPECT_EQ(size_of(with(line)), with(line).size()) << line;
}

}  // namespace
}  // namespace coupler::host
