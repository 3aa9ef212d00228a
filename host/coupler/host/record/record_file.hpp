// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace coupler::host {

/// The files of a recording. The newest has the name that was given, as press.jsonl; a full one becomes
/// press.1.jsonl, the next press.2.jsonl and so on, also over several runs. The oldest are deleted: when all
/// are larger than is to be kept together, and when the disk is full. What a file holds is whole lines, also
/// after a write that failed.
class RecordFile {
 public:
  struct Limits {
    std::uint64_t keep = std::uint64_t{1} << 30;  ///< bytes of all files together
    bool sync = false;                            ///< each write reaches the disk before it returns
  };

  /// A file that is there is kept, as the last of those before. Error, with what to do: it is no recording,
  /// or no file can be made there. The file is readable for its owner and his group.
  static tl::expected<RecordFile, std::string> open(std::filesystem::path path, Limits limits);
  /// Lines go to standard output, all in one.
  static RecordFile standard_output();
  RecordFile(RecordFile&& other) noexcept;
  RecordFile& operator=(RecordFile&&) = delete;
  ~RecordFile();

  /// Returns whether the next lines need a new file, because the open one has its share of what is kept.
  bool is_full() const { return !is_stream_ && size_ >= begin_size_ + share_; }
  /// Begins the next file with these lines; the one that is open, if it is empty.
  tl::expected<void, std::string> begin(std::string_view lines);
  /// Appends lines. Error: none of them is written, and no older file is left to make room.
  tl::expected<void, std::string> write(std::string_view lines);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t written() const { return written_; }  ///< bytes, in all files of this run

 private:
  static constexpr std::uint64_t largest_share = 128 << 20;

  RecordFile(std::filesystem::path path, Limits limits);
  tl::expected<void, std::string> create();
  void close();
  std::uint64_t share() const;
  int write_all(std::string_view lines);
  tl::expected<void, std::string> append(std::string_view lines, std::size_t kept);
  bool delete_oldest(std::size_t kept);
  void delete_what_is_too_much();

  std::filesystem::path path_;
  Limits limits_;
  std::uint64_t share_ = largest_share;  ///< bytes of one file; begin() says how many
  bool is_stream_ = false;               ///< nothing that is written can be taken back
  int fd_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t begin_size_ = 0;  ///< what it began with, which may be much where there are many points
  std::uint64_t written_ = 0;
};

}  // namespace coupler::host
