#include "base/hdf5/handle.hpp"

#include <utility>

#include "base/error.hpp"

namespace actformer::hdf5 {

Handle::~Handle() {
    if (id_ >= 0 && close_) close_(id_);
}

bool Handle::close() {
    const auto id = std::exchange(id_, -1);
    return id < 0 || !close_ || close_(id) >= 0;
}

Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Handle& Handle::operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
}

Handle checked(hid_t id, herr_t (*close)(hid_t), const char* what) {
    if (id < 0) throw Error("HDF5: {} failed; is there enough memory?", what);
    return {id, close};
}

void silence() {
    static const bool once = H5dont_atexit() >= 0 && H5Lunregister(H5L_TYPE_EXTERNAL) >= 0;
    static_cast<void>(once);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace actformer::hdf5
