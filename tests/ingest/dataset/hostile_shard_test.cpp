// Shards and motions files whose arrays have other extents than they should.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/hdf5/handle.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/made_dataset.hpp"

namespace actformer {
namespace {

namespace fs = std::filesystem;
using hdf5::Handle;

void add_floats(hid_t file, const char* name, const hdf5::Shape& shape) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Handle set(
        H5Dcreate2(file, name, H5T_IEEE_F32LE, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    ASSERT_TRUE(set);
    const std::vector<float> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    if (!values.empty()) {
        ASSERT_GE(H5Dwrite(set.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
}

TEST(HostileShard, LimbLengthsOfAnotherShapeAreDamage) {
    const test::TempDir dir;
    const test::ArmsClip clip(0, 0, 12);
    ingest::DatasetHeader header;
    header.name = "arms";
    header.topology = test::ArmsClip::topology();
    header.classes = {"swing"};
    test::write_dataset(dir / "arms", header, {{{}, clip.in({}), clip.bone_length()}});
    const auto shard = dir / "arms/shard-00000.h5";
    EXPECT_EQ(ingest::read_clips(shard, header, 0).size(), 1U);
    const hsize_t joints = header.topology.joints();
    for (const hdf5::Shape& shape : {hdf5::Shape{1, 0, joints}, {1, 1, 1}, {1, joints}, {2, 1, joints}}) {
        {
            const Handle file(H5Fopen(shard.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
            ASSERT_GE(H5Ldelete(file.get(), "clip/bone_length", H5P_DEFAULT), 0);
            add_floats(file.get(), "clip/bone_length", shape);
        }
        const auto said = test::error_of([&] { ingest::read_clips(shard, header, 0); });
        EXPECT_NE(said.find("do not fit each other: damaged"), std::string::npos) << said;
    }
}

TEST(HostileMotions, ExtentsWithoutNumbersTakeNoTime) {
    const test::TempDir dir;
    const auto path = dir / "m.h5";
    const hsize_t huge = hsize_t{1} << 40;
    for (const hdf5::Shape& shape : {hdf5::Shape{3, huge, 0}, {huge * 3, 2, 0}, {3, 0xFFFF'FFFF, 0}}) {
        {
            const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
            add_floats(file.get(), "A001_0", shape);
        }
        const ingest::MotionsFile file(path);
        if (std::ranges::max(shape) == huge || shape[0] == huge * 3) {
            const auto said = test::error_of([&] { file.read("A001_0"); });
            EXPECT_NE(said.find("m.h5: 'A001_0' is no (P*3, K, T) array"), std::string::npos) << said;
        } else {
            EXPECT_TRUE(file.read("A001_0").values.empty());
        }
    }
}

TEST(HostileTopology, OfTooManyJointsIsRefusedBeforeItIsOrdered) {
    ingest::Topology chain;
    constexpr int joints = 200'000;
    for (int j = 0; j < joints; ++j) {
        chain.names.push_back(std::to_string(j));
        chain.parents.push_back(j == 0 ? -1 : (j + 1) % joints);
    }
    const auto said = test::error_of([&] { chain.check("dataset.json"); });
    EXPECT_EQ(said, "dataset.json: 200000 joints, and a body may have 4096");
}

}  // namespace
}  // namespace actformer
