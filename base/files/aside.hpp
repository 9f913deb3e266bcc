// The one way to write a file: it appears whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/files/descriptor.hpp"
#include "base/files/output.hpp"
#include "base/files/temporary.hpp"

namespace actformer {

/// When what was written is brought to the disk: before the file gets its name, or by sync_all() once many files are done.
enum class Sync { now, later };

/// A file in the making, beside where it will be: "out.h5.partial" for "out.h5". It is a new file: what a killed program left
/// there is replaced, what a living one writes there and all that is no file is left alone ("out.h5.partial.1" is next). It is
/// gone at the end unless commit() was called. Of several writers of one path the last to commit wins.
///
/// A device or FIFO at `path` is written to as it is, and a symbolic link stays: the file it leads to is replaced.
/// Every failure is an Error that names the path and a remedy; behind one, commit() fails too.
class Aside {
  public:
    /// Throws Error where nothing can be written at `path`.
    explicit Aside(std::filesystem::path path, Sync sync = Sync::now);
    ~Aside();
    Aside(const Aside&) = delete;
    Aside& operator=(const Aside&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Puts `bytes` behind what was written so far. Large ones that begin at a page go past the page cache.
    void write(std::string_view bytes);

    /// For libraries that go back and forth in a file. A device or FIFO is refused. Reading past the end gives zeros.
    void write_at(std::uint64_t at, std::string_view bytes);
    void read_at(std::uint64_t at, char* to, std::size_t bytes);
    void resize(std::uint64_t bytes);
    std::uint64_t size();

    /// All bytes are in the file, and on the disk: what can fail has not, but for the name.
    void settle();

    /// Throws the Error of the first failure again, where there was one.
    void check() const;

    /// Settles the file and gives it its name; replaces what was there.
    void commit();

  private:
    std::filesystem::path create();
    void open_stream();
    void put(std::string_view bytes);
    void flush();
    void write_blocks_directly(std::string_view& bytes);
    void need_file();
    [[noreturn]] void fail();

    std::filesystem::path path_;
    Output output_;
    Sync sync_;
    std::optional<Temporary> temporary_;
    Descriptor file_, lock_;  ///< the same file; the second keeps it locked until it has its name
    std::string buffer_;
    std::uint64_t at_ = 0;  ///< bytes that write() has handed to the system
    std::string failure_;
    bool settled_ = false, committed_ = false;
};

/// What a user may do where writing failed for this reason, an errno.
std::string remedy(int error);

/// Brings a file that was added to to the disk. Throws Error.
void sync_file(const std::filesystem::path& path);

/// Brings the files of a folder, and of those in it, to the disk one by one, and their names. Throws Error.
void sync_folder(const std::filesystem::path& folder);

/// Brings the names of what lies in `folder` to the disk. Throws Error.
void sync_names(const std::filesystem::path& folder);

/// Brings all files of the file system that `folder` lies in to the disk, for many that were written with Sync::later: one by one
/// they would take milliseconds each. Throws Error where some could not be written.
void sync_all(const std::filesystem::path& folder);

}  // namespace actformer
