// The chunk checksum against HDF5's own, which refuses to read a chunk whose checksum it does not find right.
#include "base/checksum/fletcher32.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <random>

#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer;

namespace {

/// HDF5's checksum of `values`: that of the one chunk that they are stored as.
std::uint32_t checksum_by_hdf5(const std::vector<float>& values) {
    const test::TempDir folder;
    const auto path = folder.path() / "chunk.h5";
    {
        hdf5::Writer file(path);
        file.write<float>("values", {values.size()}, values, values.size());
        file.finish();
    }
    const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const hdf5::Handle set(H5Dopen2(file.get(), "values", H5P_DEFAULT), H5Dclose);
    std::vector<std::uint32_t> stored(values.size() + 1);
    std::uint32_t left_out = 0;
    const hsize_t origin = 0;
    EXPECT_GE(H5Dread_chunk(set.get(), H5P_DEFAULT, &origin, &left_out, stored.data()), 0);
    return stored.back();
}

std::vector<float> of_bits(std::size_t count, const std::function<std::uint32_t()>& bits) {
    std::vector<float> values(count);
    for (auto& value : values) value = std::bit_cast<float>(bits());
    return values;
}

}  // namespace

TEST(Fletcher32, IsThatOfHdf5) {
    std::mt19937 random(1);
    for (const std::size_t count : {1, 2, 15, 16, 17, 63, 64, 4095, 4096, 4097, 19200, 50000})
        for (int round = 0; round < 3; ++round) {
            const auto values = of_bits(count, random);
            EXPECT_EQ(fletcher32(values), checksum_by_hdf5(values)) << count;
        }
}

TEST(Fletcher32, TellsNothingFromASumThatDividesEvenly) {
    for (const std::size_t count : {1, 16, 1000, 30000})
        for (const std::uint32_t bits : {0x00000000U, 0xFFFFFFFFU, 0xFFFF0000U, 0x00010000U, 0xFFFE0001U}) {
            const auto values = of_bits(count, [bits] { return bits; });
            EXPECT_EQ(fletcher32(values), checksum_by_hdf5(values)) << count << " times " << bits;
        }
}

TEST(Fletcher32, ChunksOfPiecesAreReadBackByHdf5) {
    std::mt19937 random(2);
    const test::TempDir folder;
    const auto path = folder.path() / "pieces.h5";
    const auto values = of_bits(1000 * 6, [&] { return random() >> 2; });  // no NaN, which equals nothing
    const std::span<const float> all(values);
    {
        hdf5::Writer file(path);
        file.write_pieces("values", {1000, 2, 3}, {all.first(6), all.subspan(6, 2400), {}, all.subspan(2406)},
                          256);
        file.finish();
    }
    const hdf5::Reader file(path);
    EXPECT_EQ(file.shape("values"), (hdf5::Shape{1000, 2, 3}));
    EXPECT_EQ(file.read<float>("values"), values);
}
