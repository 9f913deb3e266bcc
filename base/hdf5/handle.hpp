// What reading and writing HDF5 share: handles that close themselves, and how C++ types are called there.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <vector>

namespace actformer::hdf5 {

/// An HDF5 identifier, closed by the function that fits its kind.
class Handle {
  public:
    Handle() = default;
    Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
    ~Handle();
    Handle(Handle&& other) noexcept;
    Handle& operator=(Handle&& other) noexcept;
    hid_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

    /// False where closing failed, which may be the moment when values are written.
    bool close();

  private:
    hid_t id_ = -1;
    herr_t (*close_)(hid_t) = nullptr;
};

template <typename T>
hid_t type_of();
template <>
inline hid_t type_of<float>() {
    return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t type_of<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <>
inline hid_t type_of<std::uint64_t>() {
    return H5T_NATIVE_UINT64;
}

template <>
inline hid_t type_of<std::int64_t>() {
    return H5T_NATIVE_INT64;
}
template <>
inline hid_t type_of<double>() {
    return H5T_NATIVE_DOUBLE;
}

using Shape = std::vector<hsize_t>;

/// Throws Error, with `what` was tried, for an identifier that is none.
Handle checked(hid_t id, herr_t (*close)(hid_t), const char* what);

/// Called before the library is used. Keeps it quiet: it would print its own stack of errors beside ours, and at exit warn of
/// files that a full disk left open. Keeps it from following links into other files.
void silence();

}  // namespace actformer::hdf5
