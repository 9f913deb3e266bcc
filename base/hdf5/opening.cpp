#include "base/hdf5/opening.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/files/lock.hpp"
#include "base/files/nearest_file.hpp"

namespace actformer::hdf5 {
namespace {

/// Superblocks of version 3 (h5py's libver='latest') note that the file is open for writing. A program that is killed leaves the
/// note behind.
bool left_open(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 12> start{};
    file.read(start.data(), start.size());
    return file && std::string_view(start.data(), 8) == "\x89HDF\r\n\x1a\n" && start[8] == 3 &&
           start[11] != 0;
}

[[noreturn]] void refuse_damaged(const std::string& name) {
    throw Error("{}: damaged: checksum mismatch; make it again, or copy it again", name);
}

}  // namespace

Handle open_to_read(const std::filesystem::path& path) {
    silence();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw Error("{}: no such file{}", path.string(), did_you_mean(path));
    if (!std::filesystem::is_regular_file(status))
        throw Error("{}: not a file; an HDF5 file is expected", path.string());
    if (::access(path.c_str(), R_OK) != 0)
        throw Error("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));
    if (std::filesystem::file_size(path) == 0)
        throw Error("{}: empty; an HDF5 file is expected", path.string());
    if (own_checksum_of_file(path) == OwnChecksum::wrong) refuse_damaged(path.string());
    Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (file) return file;
    if (FileLock::is_held(path))  // as the library holds what it writes
        throw Error(
            "{}: open for writing elsewhere; close it there, or set HDF5_USE_FILE_LOCKING=FALSE to read it "
            "all "
            "the same",
            path.string());
    if (left_open(path))
        throw Error(
            "{}: open for writing elsewhere, or left so by a program that was killed: h5clear -s mends it",
            path.string());
    throw Error("{}: not an HDF5 file, or damaged", path.string());
}

Handle open_in_memory(std::string_view image, const std::string& name) {
    silence();
    if (own_checksum(image) == OwnChecksum::wrong) refuse_damaged(name);
    const auto access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "opening a file in memory");
    H5Pset_fapl_core(access.get(), std::size_t{1} << 16, false);
    if (image.empty() || H5Pset_file_image(access.get(), const_cast<char*>(image.data()), image.size()) < 0)
        throw Error("{}: not an HDF5 file, or damaged", name);
    Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!file) throw Error("{}: not an HDF5 file, or damaged", name);
    return file;
}

}  // namespace actformer::hdf5
