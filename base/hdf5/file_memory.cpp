#include "base/hdf5/file_memory.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/files/file.hpp"

namespace actformer::hdf5 {
namespace {

// The library grows a file by such steps, and zeroes what it grows by: as little as that is still in the processor's cache
// when its values come, and no more than a page of it is left over at the end.
constexpr std::size_t page = direct_block;

}  // namespace

void FileMemory::serve(hid_t access) {
    H5Pset_fapl_core(access, page, false);
    H5FD_file_image_callbacks_t callbacks{};
    callbacks.udata = this;
    callbacks.udata_copy = [](void* self) { return self; };
    callbacks.udata_free = [](void*) -> herr_t { return 0; };
    callbacks.image_realloc = [](void*, std::size_t size, H5FD_file_image_op_t, void* self) {
        return static_cast<FileMemory*>(self)->resize(size);
    };
    callbacks.image_free = [](void*, H5FD_file_image_op_t, void* self) -> herr_t {
        static_cast<FileMemory*>(self)->bytes_.reset();
        return 0;
    };
    H5Pset_file_image_callbacks(access, &callbacks);
}

/// Null where there is not enough memory, which the library reports.
void* FileMemory::resize(std::size_t size) {
    if (size > room_) {
        const auto wanted = (std::max(size + size / 2, expected_) + page - 1) / page * page;
        decltype(bytes_) grown(static_cast<char*>(std::aligned_alloc(page, wanted)), &std::free);
        if (!grown) return nullptr;
        if (bytes_) std::memcpy(grown.get(), bytes_.get(), used_);
        bytes_ = std::move(grown);
        room_ = wanted;
    }
    used_ = size;
    return bytes_.get();
}

}  // namespace actformer::hdf5
