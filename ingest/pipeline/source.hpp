// Raw files wherever they are: nested folders, single files, and archives as downloaded (.zip, .tar.*), read through libarchive.
// Large members of archives are unpacked to a disk, into the system's folder for temporary files, and are gone when they are read.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/scratch.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

inline constexpr std::uint64_t usual_largest_file = std::uint64_t{128} << 20;

/// One file of a source: on disk to be read when wanted, or already in memory (out of an archive).
struct RawFile {
    std::string path;  ///< for messages: the file, or archive:member
    std::string stem;  ///< file name without folder and extension
    std::string
        inside;  ///< path below the folder or archive that was given; of a file that was given itself: as given
    std::uint64_t index = 0;  ///< how many files come before it
    std::uint64_t size = 0;   ///< bytes of text
    bool in_memory = false;
    std::vector<char> bytes;  ///< in_memory: the text and 64 zero bytes after it
    std::string
        unreadable;  ///< why it cannot be read: a FIFO, or too large a member of an archive; else empty
    std::shared_ptr<const Scratch> unpacked{};  ///< of a large member of an archive: the folder with its text

    /// The text, in `scratch` or in `bytes`, followed by 64 zero bytes. Throws Error where the file cannot be read, or has more than
    /// `largest` bytes.
    std::string_view text(std::vector<char>& scratch, std::uint64_t largest = usual_largest_file) const;

    /// Where its text is on a disk, if it is.
    std::filesystem::path on_disk() const;

    /// As formats see it, with `text` or by its name alone.
    RawText raw(std::string_view text = {}, const MappedFile* mapped = nullptr) const {
        return {path, stem, text, inside, index, !in_memory && !unpacked, mapped, nullptr};
    }
};

/// What a thread reads texts into; it keeps its memory from file to file.
class TextMemory {
  public:
    explicit TextMemory(std::uint64_t largest_file) : largest_(largest_file) {}

    /// The text of `file`, as in RawFile::text, until the next call. Large files are mapped.
    RawText read(const RawFile& file);

  private:
    std::uint64_t largest_;
    std::vector<char> scratch_;
    std::optional<MappedFile> mapped_;
};

/// Walks RAW paths in an order that depends on names alone: paths as given, folders sorted, archives as stored. Links to folders are
/// followed.
class Source {
  public:
    /// Of an archive, members beyond `largest_file` bytes come unreadable. `threads` look at the files, 0: one a core. What is in folders
    /// of `left_out` is passed over. Throws Error where a path is missing or neither folder, archive nor a file with one of `extensions`.
    Source(const std::vector<std::filesystem::path>& raw, const std::vector<std::string_view>& extensions,
           std::uint64_t largest_file = usual_largest_file, unsigned threads = 0,
           const std::vector<std::filesystem::path>& left_out = {});
    ~Source();

    /// The next file; false at the end. Throws Error naming the archive and member where an archive is broken.
    bool next(RawFile& file);

    /// From now on next() leaves the bytes of archive members behind unless `wanted`.
    void unpack_only(std::function<bool(const RawFile&)> wanted);

    /// Like next, but leaves the bytes of archive members behind: for listing and for skipping.
    bool next_name(RawFile& file);

    std::uint64_t bytes_total() const;  ///< on disk: of files and archives
    std::uint64_t bytes_read() const;   ///< how many of those next() has passed

    /// The lines of remarks_on_packed() on archives and compressed files in folders: they are not read unless they are given themselves.
    const std::vector<std::string>& not_read() const;

    /// Fingerprint of which files there are: paths, sizes and times of change. Differs where a re-run would differ.
    std::string listing() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace actformer::ingest
