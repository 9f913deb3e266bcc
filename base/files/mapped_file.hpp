// A large file in memory without reading it first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "base/files/mapping_watch.hpp"

namespace actformer {

/// The file must not shrink while this lives: reading what is gone then ends the program, with a line (see mapping_watch.hpp).
class MappedFile {
  public:
    /// Throws Error where it cannot be opened or mapped.
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;

    /// What it holds, followed by text_padding zero bytes.
    std::string_view text() const { return {memory_, size_}; }

    /// Bytes before `here` are not needed for now: the memory they take becomes free, some megabytes at a time. They can still be
    /// read. Nothing happens where `here` lies elsewhere. Not from several threads at once.
    void release(const char* here) const;

    /// `bytes` more of it, wherever they lie, are not needed for now: from time to time the memory that any of it takes becomes free.
    /// Not from several threads at once.
    void release_read(std::size_t bytes) const;

  private:
    char* memory_ = nullptr;
    std::size_t size_ = 0, mapped_ = 0;
    mutable std::size_t released_ = 0;  ///< bytes before this lie in no memory
    mutable std::size_t read_ = 0;      ///< bytes that release_read() was told of and has not released
    MappingWatch watch_;
};

}  // namespace actformer
