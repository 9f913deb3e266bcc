// A virtual file driver (HDF5 Virtual File Layer) over Aside. It has the features of the library's own driver, on which the layout
// of a file depends.
#include "base/hdf5/file_on_disk.hpp"

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>

#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {
namespace {

/// The library's part comes first, as it has no more than a pointer to it.
struct OpenFile {
    H5FD_t library{};
    Aside* aside = nullptr;
    haddr_t allocated = 0, end = 0;
};

OpenFile& ours(H5FD_t* file) {
    return *reinterpret_cast<OpenFile*>(file);
}

const OpenFile& ours(const H5FD_t* file) {
    return *reinterpret_cast<const OpenFile*>(file);
}

/// The library is C: failures are told by numbers. The Aside remembers which it was.
template <typename Do>
herr_t done(const Do& what) {
    try {
        what();
        return 0;
    } catch (const std::exception&) {
        return -1;
    }
}

H5FD_t* open(const char*, unsigned, hid_t access, haddr_t) {
    auto* const* aside = static_cast<Aside* const*>(H5Pget_driver_info(access));
    if (!aside) return nullptr;
    auto file = std::make_unique<OpenFile>();
    file->aside = *aside;
    return &file.release()->library;
}

herr_t close(H5FD_t* file) {
    const std::unique_ptr<OpenFile> gone(&ours(file));
    return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
    if (flags)
        *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                 H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) {
    return ours(file).allocated;
}

herr_t allocate(H5FD_t* file, H5FD_mem_t, haddr_t bytes) {
    ours(file).allocated = bytes;
    return 0;
}

haddr_t end(const H5FD_t* file, H5FD_mem_t) {
    return ours(file).end;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
    return done([&] { ours(file).aside->read_at(at, static_cast<char*>(to), size); });
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) {
    return done([&] {
        ours(file).aside->write_at(at, {static_cast<const char*>(from), size});
        ours(file).end = std::max<haddr_t>(ours(file).end, at + size);
    });
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
    auto& one = ours(file);
    if (one.end == one.allocated) return 0;
    return done([&] {
        one.aside->resize(one.allocated);
        one.end = one.allocated;
    });
}

H5FD_class_t driver() {
    H5FD_class_t own{};
#if H5_VERSION_GE(1, 13, 0)
    own.version = H5FD_CLASS_VERSION;
    own.value = static_cast<H5FD_class_value_t>(511);  // the last of those left to programs
#endif
    own.name = "actformer";
    own.maxaddr = static_cast<haddr_t>(std::numeric_limits<std::int64_t>::max());
    own.fc_degree = H5F_CLOSE_WEAK;
    own.fapl_size = sizeof(Aside*);
    own.open = open;
    own.close = close;
    own.query = query;
    own.get_eoa = allocated;
    own.set_eoa = allocate;
    own.get_eof = end;
    own.read = read;
    own.write = write;
    own.truncate = truncate;
    const H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kinds), std::end(kinds), own.fl_map);
    return own;
}

}  // namespace

void serve(Aside& file, hid_t access) {
    static const H5FD_class_t own = driver();
    static const hid_t registered = H5FDregister(&own);
    const Aside* aside = &file;
    checked(H5Pset_driver(access, registered, &aside) >= 0 ? 0 : -1, nullptr, "making a file");
}

}  // namespace actformer::hdf5
