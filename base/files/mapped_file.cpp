#include "base/files/mapped_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <functional>
#include <utility>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"
#include "base/files/file.hpp"
#include "base/files/regular_file.hpp"

namespace actformer {
namespace {

constexpr std::size_t released_at_once = std::size_t{8}
                                         << 20;  // each release interrupts all threads of the process
constexpr std::size_t page = 4096;  // of x86-64 and most others; larger ones hold whole multiples of it

std::size_t whole_pages(std::size_t bytes) {
    const auto size = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE) > 0 ? ::sysconf(_SC_PAGESIZE) : page);
    return (bytes + size - 1) / size * size;
}

}  // namespace

// Zero bytes first, for the padding, and the file over their beginning: what the file leaves of its last page is zero too.
MappedFile::MappedFile(const std::filesystem::path& path) {
    const auto [file, size] = open_to_read(path);
    size_ = static_cast<std::size_t>(size);
    mapped_ = whole_pages(size_ + text_padding);
    void* all = ::mmap(nullptr, mapped_, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    void* over = all == MAP_FAILED || size_ == 0
                     ? all
                     : ::mmap(all, size_, PROT_READ, MAP_PRIVATE | MAP_FIXED, file.get(), 0);
    const auto why = reason();
    if (over == MAP_FAILED) {
        if (all != MAP_FAILED) ::munmap(all, mapped_);
        throw Error("{}: cannot be read: {}", path.string(), why);
    }
    memory_ = static_cast<char*>(all);
    ::madvise(memory_, mapped_, MADV_SEQUENTIAL);
    watch_ = MappingWatch(memory_, mapped_, path);
}

MappedFile::~MappedFile() {
    watch_ = {};  // before others may have the same place
    if (memory_) ::munmap(memory_, mapped_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)),
      size_(other.size_),
      mapped_(other.mapped_),
      released_(other.released_),
      read_(other.read_),
      watch_(std::move(other.watch_)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    std::swap(released_, other.released_);
    std::swap(read_, other.read_);
    std::swap(watch_, other.watch_);
    return *this;
}

void MappedFile::release_read(std::size_t bytes) const {
    read_ += bytes;
    if (read_ < released_at_once) return;
    ::madvise(memory_, mapped_, MADV_DONTNEED);
    released_ = read_ = 0;
}

void MappedFile::release(const char* here) const {
    if (std::less<>()(here, memory_) || std::less<>()(memory_ + size_, here)) return;  // in memory of its own
    const auto bytes = static_cast<std::size_t>(here - memory_), beyond = whole_pages(bytes);
    const auto passed = beyond == bytes ? bytes : beyond - whole_pages(1);
    if (passed < released_) released_ = 0;  // read from the beginning again
    if (passed - released_ < released_at_once) return;
    ::madvise(memory_ + released_, passed - released_, MADV_DONTNEED);
    released_ = passed;
}

}  // namespace actformer
