#include "base/hdf5/file_memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/files/file.hpp"

namespace actformer::hdf5 {
namespace {

// The library grows a file by such steps, and zeroes what it grows by: as little as that is still in the processor's cache
// when its values come, and no more than a page of it is left over at the end.
constexpr std::size_t page = direct_block;

/// None where there is not enough memory.
std::unique_ptr<char, Unmap> map(std::size_t bytes) {
    void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return {};
    ::madvise(memory, bytes,
              MADV_HUGEPAGE);  // a page of 2 MiB costs one fault where 512 small ones cost as many
    return std::unique_ptr<char, Unmap>(static_cast<char*>(memory), {bytes});
}

}  // namespace

void FileMemory::serve(hid_t access, std::size_t expected) {
    expected_ = expected;
    used_ = 0;
    if (block_.get_deleter().bytes < expected) block_ = std::unique_ptr<char, Unmap>();
    H5Pset_fapl_core(access, page, false);
    H5FD_file_image_callbacks_t callbacks{};
    callbacks.udata = this;
    callbacks.udata_copy = [](void* self) { return self; };
    callbacks.udata_free = [](void*) -> herr_t { return 0; };
    callbacks.image_realloc = [](void*, std::size_t size, H5FD_file_image_op_t, void* self) {
        return static_cast<FileMemory*>(self)->resize(size);
    };
    callbacks.image_free = [](void*, H5FD_file_image_op_t, void* self) -> herr_t {
        static_cast<FileMemory*>(self)->used_ = 0;
        return 0;
    };
    H5Pset_file_image_callbacks(access, &callbacks);
}

void Unmap::operator()(char* memory) const {
    ::munmap(memory, bytes);
}

/// Null where there is not enough memory, which the library reports.
void* FileMemory::resize(std::size_t size) {
    if (size > block_.get_deleter().bytes) {
        auto grown = map((std::max(size + size / 2, expected_) + page - 1) / page * page);
        if (!grown) return nullptr;
        if (block_) std::memcpy(grown.get(), block_.get(), used_);
        block_ = std::move(grown);
    }
    used_ = size;
    return block_.get();
}

}  // namespace actformer::hdf5
