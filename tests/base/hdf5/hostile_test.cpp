// Files that ask for more memory than they can fill, or that point outside themselves.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <functional>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& e) {
        return e.what();
    }
    return "not refused";
}

/// Replaces every 8-byte number `from` in the file, such as an extent, and drops the checksum at its end.
void replace_number(const fs::path& path, std::uint64_t from, std::uint64_t to) {
    auto bytes = read_file(path);
    bytes.resize(bytes.size() - checksum_line({}).size());
    int found = 0;
    for (std::size_t at = 0; at + 8 <= bytes.size(); ++at)
        if (std::memcmp(&bytes[at], &from, 8) == 0) {
            std::memcpy(&bytes[at], &to, 8);
            ++found;
        }
    ASSERT_GT(found, 0);
    write_file(path, bytes);
}

struct HostileFile : testing::Test {
    TempDir dir;
    fs::path path = dir / "file.h5";

    /// An array "motion" of (4241, 3) numbers, in chunks or in one piece.
    void write(hsize_t rows_a_chunk) const {
        hdf5::Writer writer(path);
        writer.write<float>("motion", {4241, 3}, std::vector<float>(4241 * 3, 1.5F), rows_a_chunk);
        writer.finish();
    }
    std::string refusal_to_read() const {
        return refusal([&] { hdf5::Reader(path).read<float>("motion"); });
    }

    /// An array "motion" of two numbers, made with `plan`.
    void create(hid_t plan, const hdf5::Shape& shape = {2}, const hsize_t* most = nullptr) const {
        const hdf5::Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
        const hdf5::Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), most),
                                 H5Sclose);
        const hdf5::Handle set(
            H5Dcreate2(file.get(), "motion", H5T_NATIVE_FLOAT, space.get(), H5P_DEFAULT, plan, H5P_DEFAULT),
            H5Dclose);
        ASSERT_GE(set.get(), 0);
    }

    /// An array "name" of texts of variable length.
    void write_texts(const std::vector<std::string>& texts) const {
        const hdf5::Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
        const hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(type.get(), H5T_VARIABLE);
        const hsize_t count = texts.size();
        const hdf5::Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
        const hdf5::Handle set(
            H5Dcreate2(file.get(), "name", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose);
        std::vector<const char*> values;
        for (const auto& text : texts) values.push_back(text.c_str());
        H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
};

}  // namespace

TEST_F(HostileFile, AShapeWhoseProductWrapsIsRefused) {
    for (const hsize_t rows_a_chunk : {0, 64})
        for (const std::uint64_t rows : {std::uint64_t{1} << 62, std::uint64_t{6148914691236517206},
                                         std::uint64_t{1} << 40, ~std::uint64_t{0} - 1}) {
            write(rows_a_chunk);
            ASSERT_EQ(hdf5::Reader(path).read<float>("motion").size(), 4241U * 3);
            replace_number(path, 4241, rows);
            const auto why = refusal_to_read();
            EXPECT_NE(why.find("file.h5"), std::string::npos) << rows << ": " << why;
            EXPECT_NE(why.find("damaged"), std::string::npos) << rows << ": " << why;
            EXPECT_NE(refusal([&] { hdf5::Reader(path).read_rows("motion", 0, rows); }), "not refused");
            EXPECT_NE(refusal([&] { hdf5::Reader(path).shape("motion"); }), "not refused")
                << "callers multiply what they get";
        }
}

TEST_F(HostileFile, RowsPastTheEndAreRefused) {
    write(64);
    const hdf5::Reader file(path);
    EXPECT_EQ(file.read_rows("motion", 4240, 1), (std::vector<float>{1.5F, 1.5F, 1.5F}));
    EXPECT_EQ(file.read_rows("motion", 4241, 0), std::vector<float>{});
    for (const auto& rows :
         {std::pair<std::uint64_t, std::uint64_t>{4240, 2}, {4242, 0}, {1, ~std::uint64_t{0}}})
        EXPECT_NE(refusal([&] { file.read_rows("motion", rows.first, rows.second); }).find("has no rows"),
                  std::string::npos);
}

TEST_F(HostileFile, AChunkLargerThanTheFileIsRefused) {
    const hdf5::Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t chunk = 1 << 28, most = H5S_UNLIMITED;
    H5Pset_chunk(plan.get(), 1, &chunk);
    create(plan.get(), {2}, &most);
    EXPECT_NE(refusal_to_read().find("chunks larger than the file"), std::string::npos) << refusal_to_read();
}

TEST_F(HostileFile, WhatWasNeverFilledIsRefused) {
    create(H5P_DEFAULT, {1'000'000});
    EXPECT_NE(refusal_to_read().find("never filled"), std::string::npos) << refusal_to_read();
    create(H5P_DEFAULT, {0, 25});
    EXPECT_TRUE(hdf5::Reader(path).read<float>("motion").empty());
}

TEST_F(HostileFile, ExternalStorageIsRefused) {
    write_file(dir / "secret", "12345678");
    const hdf5::Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_external(plan.get(), (dir / "secret").c_str(), 0, 8);
    create(plan.get());
    EXPECT_NE(refusal_to_read().find("keeps its numbers in another file"), std::string::npos)
        << refusal_to_read();
}

TEST_F(HostileFile, AVirtualArrayIsRefusedThoughItNamesItself) {
    const hdf5::Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t two = 2;
    const hdf5::Handle space(H5Screate_simple(1, &two, nullptr), H5Sclose);
    ASSERT_GE(H5Pset_virtual(plan.get(), space.get(), ".", "motion", space.get()), 0);
    create(plan.get());
    EXPECT_NE(refusal_to_read().find("virtual array"), std::string::npos) << refusal_to_read();
    EXPECT_NE(refusal([&] { hdf5::Reader(path).shape("motion"); }).find("virtual array"), std::string::npos);
}

TEST_F(HostileFile, ExternalLinksAreRefusedByName) {
    if (!python_has("h5py")) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    write(0);
    const auto other = dir / "other.h5";
    // In another process: this one makes none either.
    const auto made = run_command("/usr/bin/python3 -c \"import h5py; f = h5py.File('" + other.string() +
                                  "', 'w'); f['motion'] = h5py.ExternalLink('" + path.string() +
                                  "', 'motion'); f['all'] = h5py.ExternalLink('" + path.string() +
                                  "', '/'); f['round about'] = h5py.SoftLink('/all/motion'); "
                                  "f.create_group('group'); f['group/up'] = h5py.SoftLink('/motion'); "
                                  "f['beside'] = h5py.SoftLink('group/up'); "
                                  "f['in a circle'] = h5py.SoftLink('/in a circle')\"");
    ASSERT_EQ(made.exit, 0) << made.output;
    const hdf5::Reader file(other);
    EXPECT_EQ(file.names(),
              (std::vector<std::string>{"all", "beside", "group", "in a circle", "motion", "round about"}));
    for (const auto* name : {"motion", "all/motion"}) {
        EXPECT_NE(refusal([&] { file.read<float>(name); }).find("link into another file"), std::string::npos);
        EXPECT_NE(refusal([&] { file.is_array(name); }).find("link into another file"), std::string::npos);
    }
    for (const auto* name : {"round about", "beside"}) {
        EXPECT_NE(refusal([&] { file.read<float>(name); }).find("link into another file"), std::string::npos);
        EXPECT_NE(refusal([&] { file.is_array(name); }).find("link into another file"), std::string::npos);
    }
    EXPECT_NE(refusal([&] { file.read<float>("in a circle"); }), "not refused");
    EXPECT_FALSE(file.is_array("in a circle"));
}

TEST_F(HostileFile, LongPathsAreRefusedBeforeTheyAreFollowed) {
    write(0);
    std::string deep, shallow;
    for (int i = 0; i < 200; ++i) deep += "/r";
    for (int i = 0; i < 20; ++i) shallow += "/r";
    const std::string wide = "/" + std::string(5000, 'x');
    {
        const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        ASSERT_GE(H5Lcreate_hard(file.get(), "/", file.get(), "r", H5P_DEFAULT, H5P_DEFAULT), 0);
        for (const auto& [name, to] :
             {std::pair{"deep", deep + "/motion"}, {"wide", wide}, {"shallow", shallow + "/motion"}})
            ASSERT_GE(H5Lcreate_soft(to.c_str(), file.get(), name, H5P_DEFAULT, H5P_DEFAULT), 0);
    }
    const hdf5::Reader file(path);
    EXPECT_EQ(file.read<float>("shallow").size(), 4241U * 3);
    for (const auto& name : {std::string("deep"), std::string("wide"), deep + "/motion", wide}) {
        const auto why = refusal([&] { file.is_array(name); });
        EXPECT_NE(why.find("file.h5: '/"), std::string::npos) << why;
        EXPECT_NE(why.find("is a path of more than 32 parts or 4096 bytes"), std::string::npos) << why;
        EXPECT_EQ(refusal([&] { file.read<float>(name); }), why);
    }
}

TEST_F(HostileFile, LinksThatMultiplyAreNotFollowedForEver) {
    write(0);
    std::string all;
    {
        const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        ASSERT_GE(H5Lcreate_hard(file.get(), "/", file.get(), "r", H5P_DEFAULT, H5P_DEFAULT), 0);
        for (char name = 'a'; name <= 'o'; ++name) {  // each is seen again for every one behind it
            all += std::string("/") + name;
            ASSERT_GE(
                H5Lcreate_soft("r", file.get(), all.substr(all.size() - 2).c_str(), H5P_DEFAULT, H5P_DEFAULT),
                0);
        }
    }
    const hdf5::Reader file(path);
    EXPECT_TRUE(file.is_array("a/b/c/d/motion"));
    const auto why = refusal([&] { file.is_array(all + "/motion"); });
    EXPECT_NE(why.find("leads over more than 64 links"), std::string::npos) << why;
}

TEST_F(HostileFile, ManyNamesOfOneArrayAreRefusedBeforeAllAreRead) {
    {
        hdf5::Writer writer(path);
        writer.write<float>("a", {1 << 20}, std::vector<float>(1 << 20, 1.5F));
        writer.finish();
    }
    EXPECT_NO_THROW(hdf5::Reader(path).expect_room_for({"a", "a"}));
    const std::vector<std::string> names(300, "a");  // of 4 MiB each
    const auto why = refusal([&] { hdf5::Reader(path).expect_room_for(names); });
    EXPECT_EQ(why, path.string() +
                       ": its 300 arrays would take 1200 MiB out of 4 MiB: names of one array, or damaged; "
                       "make it again");
}

TEST_F(HostileFile, AnArrayThatDeflatedToNextToNothingIsRefused) {
    const hsize_t rows = hsize_t{1} << 29, chunk = rows / 4;
    const hdf5::Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(plan.get(), 1, &chunk);
    H5Pset_deflate(plan.get(), 1);
    create(plan.get(), {rows});
    // Chunks that were never deflated: their sizes are all that is looked at.
    {
        const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        const hdf5::Handle set(H5Dopen2(file.get(), "motion", H5P_DEFAULT), H5Dclose);
        const std::vector<char> stored(1 << 20);
        for (hsize_t at = 0; at < rows; at += chunk)
            ASSERT_GE(H5Dwrite_chunk(set.get(), H5P_DEFAULT, 0, &at, stored.size(), stored.data()), 0);
    }
    const auto why = refusal_to_read();
    EXPECT_NE(why.find("'motion' would take 2048 MiB out of 4 MiB"), std::string::npos) << why;
    EXPECT_NE(why.find("h5repack"), std::string::npos) << why;
}

TEST_F(HostileFile, ACheckedChunkThatIsNotThereIsRefusedAndNotTakenForZeros) {
    const hsize_t rows[] = {4241, 3}, chunk[] = {64, 3};
    for (const unsigned left_out : {0U, 1U}) {
        const hdf5::Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        H5Pset_chunk(plan.get(), 2, chunk);
        H5Pset_fletcher32(plan.get());
        create(plan.get(), {rows[0], rows[1]});
        {
            const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
            const hdf5::Handle set(H5Dopen2(file.get(), "motion", H5P_DEFAULT), H5Dclose);
            const std::vector<float> values(64 * 3 + 1);  // zeros, and so is their checksum
            for (hsize_t at[] = {0, 0}; at[0] < rows[0]; at[0] += 64) {
                const bool odd = at[0] == 640;
                if (odd && left_out == 0) continue;
                ASSERT_GE(H5Dwrite_chunk(set.get(), H5P_DEFAULT, odd ? left_out : 0, at, values.size() * 4,
                                         values.data()),
                          0);
            }
        }
        const hdf5::Reader file(path);
        EXPECT_EQ(file.read_rows("motion", 600, 40).size(), 40U * 3);
        EXPECT_EQ(file.read_rows("motion", 704, 40).size(), 40U * 3);
        const auto why = refusal([&] { file.read_rows("motion", 639, 2); });
        EXPECT_NE(why.find("file.h5: 'motion' is not what its checksum says from row 640 on"),
                  std::string::npos)
            << why;
    }
}

TEST_F(HostileFile, TextsOfVariableLengthAreReadOnlyWhereTheyAre) {
    const std::vector<std::string> texts{std::string(7777, 'x'), "", "short", std::string(3333, 'y')};
    write_texts(texts);
    EXPECT_EQ(hdf5::Reader(path).read_strings("name"), texts);
    const auto whole = read_file(path);
    EXPECT_EQ(hdf5::Reader(whole, "in memory").read_strings("name"), texts);
    for (const std::uint32_t length : {7777, 3333})  // of the text, in its reference and in the heap
        for (const std::uint32_t other : {0x70000000U, length + 1, length + 8}) {
            auto bytes = whole;
            for (std::size_t at = 0; at + 4 <= bytes.size(); ++at)
                if (std::memcmp(&bytes[at], &length, 4) == 0) std::memcpy(&bytes[at], &other, 4);
            write_file(path, bytes);
            try {
                const auto read =
                    hdf5::Reader(path).read_strings("name");  // more of the heap, but of the heap
                EXPECT_EQ(read.size(), texts.size());
                EXPECT_LT(other, 10000U);
            } catch (const Error& e) {
                EXPECT_NE(std::string(e.what()).find("damaged"), std::string::npos) << e.what();
            }
        }
}

TEST_F(HostileFile, AHeapOfTextsSmallerThanItsHeaderIsRefused) {
    write_texts({"walk", "run"});
    auto bytes = read_file(path);
    const auto heap = bytes.find("GCOL");
    ASSERT_NE(heap, std::string::npos);
    bytes.replace(heap + 9, 7, 7, '\0');
    for (char size = 0; size < 24; ++size) {
        bytes[heap + 8] = size;
        const auto why = refusal([&] { hdf5::Reader(bytes, "in memory").read_strings("name"); });
        EXPECT_NE(why.find("'name' cannot be read: damaged"), std::string::npos) << int{size} << ": " << why;
    }
}

TEST_F(HostileFile, AnAttributeLargerThanHdf5KeepsIsRefusedWithItsSize) {
    hdf5::Writer writer(path);
    const std::vector<std::string> names(500, std::string(130, 'x'));
    writer.attribute("classes", names);
    auto more = names;
    more[3] += "x";
    const auto why = refusal([&] { writer.attribute("more", more); });
    EXPECT_NE(why.find("file.h5: attribute 'more' would take 65500 bytes"), std::string::npos) << why;
    writer.finish();
    EXPECT_EQ(hdf5::Reader(path).attribute_texts("classes"), names);
}

TEST_F(HostileFile, WhatIsNoFileIsRefusedAtOnce) {
    EXPECT_NE(refusal([&] { hdf5::Reader(dir / "none"); }).find("no such file"), std::string::npos);
    EXPECT_NE(refusal([&] { hdf5::Reader(dir.path()); }).find("not a file"), std::string::npos);
    ASSERT_EQ(::mkfifo((dir / "fifo").c_str(), 0600), 0);
    EXPECT_NE(refusal([&] { hdf5::Reader(dir / "fifo"); }).find("not a file"), std::string::npos);
    write_file(path, "no HDF5");
    EXPECT_NE(refusal([&] { hdf5::Reader{path}; }).find("not an HDF5 file, or damaged"), std::string::npos);
}

TEST_F(HostileFile, OneThatAnotherProgramWritesIsTold) {
    write(0);
    const int elsewhere = ::open(path.c_str(), O_RDWR);
    ASSERT_EQ(::flock(elsewhere, LOCK_EX), 0);  // as the library does while it writes
    const auto why = refusal([&] { hdf5::Reader{path}; });
    ::close(elsewhere);
    EXPECT_NE(why.find("open for writing elsewhere"), std::string::npos) << why;
    EXPECT_NE(why.find("HDF5_USE_FILE_LOCKING=FALSE"), std::string::npos) << why;
    EXPECT_EQ(refusal([&] { hdf5::Reader{path}; }), "not refused");
}

TEST_F(HostileFile, OneLeftOpenByAKilledProgramIsTold) {
    std::string start("\x89HDF\r\n\x1a\n\x03\x08\x08\x05",
                      12);  // version 3, sizes of 8 bytes, open for writing
    write_file(path, start + std::string(2000, '\0'));
    EXPECT_NE(refusal([&] { hdf5::Reader{path}; }).find("h5clear -s"), std::string::npos);
}
