#include "base/hdf5/checked_chunk.hpp"

#include <cstring>

#include "base/checksum/fletcher32.hpp"

namespace actformer::hdf5 {

Shape checked_chunk_of(hid_t plan, std::size_t rank) {
    if (H5Pget_layout(plan) != H5D_CHUNKED || H5Pget_nfilters(plan) != 1) return {};
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    if (H5Pget_filter2(plan, 0, &flags, &values, nullptr, 0, nullptr, &config) != H5Z_FILTER_FLETCHER32)
        return {};
    Shape chunk(rank);
    if (H5Pget_chunk(plan, static_cast<int>(rank), chunk.data()) != static_cast<int>(rank)) return {};
    return chunk;
}

bool read_checked_chunk(hid_t set, const Shape& at, std::vector<float>& memory) {
    hsize_t stored = 0;
    std::uint32_t left_out = 0, sum = 0;
    if (H5Dget_chunk_storage_size(set, at.data(), &stored) < 0 || stored != memory.size() * sizeof(float) ||
        H5Dread_chunk(set, H5P_DEFAULT, at.data(), &left_out, memory.data()) < 0)
        return false;
    std::memcpy(&sum, &memory.back(), sizeof sum);
    return left_out == 0 && sum == fletcher32(std::span(memory).first(memory.size() - 1));
}

}  // namespace actformer::hdf5
