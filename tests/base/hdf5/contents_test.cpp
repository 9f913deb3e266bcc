// The checksum of contents: the same for the same numbers, texts and attributes, another for any other.
#include "base/hdf5/contents.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

struct Contents : testing::Test {
    TempDir dir;
    std::filesystem::path path = dir / "file.h5";
    std::string written, metadata;  ///< the writer's checksums

    Contents() {
        std::vector<float> motion(1000 * 6);
        for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = static_cast<float>(i) * 0.5F;
        hdf5::Writer writer(std::size_t{1} << 16);
        writer.attribute("program", std::string("as made"));
        writer.attribute("empty", std::string());
        writer.attribute("persons", std::int64_t{2});
        writer.attribute("parents", std::vector<std::int64_t>{-1, 0, 1});
        writer.attribute("bone_length", std::vector<float>{0.5F, 0.25F});
        writer.attribute("classes", std::vector<std::string>{"walk", "jump about"});
        writer.write_pieces("motion", {1000, 2, 3},
                            {std::span(motion).first(600), std::span(motion).subspan(600)}, 256);
        writer.write<std::uint32_t>("clip/label", {3}, std::vector<std::uint32_t>{4, 5, 6});
        writer.write<std::uint64_t>("clip/offset", {3}, std::vector<std::uint64_t>{0, 100, 200});
        writer.write_strings("clip/name", {"one", "second", ""});
        writer.write<float>("nothing", {0, 5}, std::vector<float>{});
        write_file(path, std::string(writer.image()));
        written = writer.contents();
        metadata = writer.metadata("motion");
    }
    std::string read() const { return hdf5::Reader(path).contents(); }

    /// Runs lines of Python with the file open as `f`.
    bool python(const std::string& lines) const {
        write_file(dir / "change.py",
                   "import h5py, sys\nwith h5py.File(sys.argv[1], 'r+') as f:\n " + lines + "\n");
        const auto ran =
            run_command("/usr/bin/python3 " + (dir / "change.py").string() + " " + path.string());
        EXPECT_EQ(ran.exit, 0) << ran.output;
        return ran.exit == 0;
    }
    static bool has_h5py() { return python_has("h5py"); }
};

}  // namespace

TEST_F(Contents, ReaderAndWriterAgree) {
    EXPECT_EQ(read(), written);
    EXPECT_EQ(hdf5::Reader(read_file(path), "in memory").contents(), written);
}

TEST_F(Contents, MetadataIsAllButTheValuesOfOneArray) {
    EXPECT_EQ(hdf5::Reader(path).metadata("motion"), metadata);
    EXPECT_NE(metadata, written);
    EXPECT_EQ(hdf5::Reader(path).metadata("none"), written);
    if (!has_h5py()) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    ASSERT_TRUE(python("f['motion'][999, 1, 2] += 1"));
    EXPECT_EQ(hdf5::Reader(path).metadata("motion"), metadata);
    ASSERT_TRUE(python("f['clip/label'][1] = 4"));
    EXPECT_NE(hdf5::Reader(path).metadata("motion"), metadata);
}

TEST_F(Contents, NumbersOfAnUnusualLayoutAreNotOurs) {
    const hdf5::Handle odd(H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose);
    EXPECT_EQ(hdf5::name_of_type(odd.get()), "float32");
    H5Tset_ebias(odd.get(), 126);  // the same bytes are twice the numbers
    EXPECT_EQ(hdf5::name_of_type(odd.get()), "");
    EXPECT_EQ(hdf5::name_of_type(H5T_STD_U64BE), "uint64be");
}

TEST_F(Contents, EveryByteOfEveryArrayIsShownInOrder) {
    std::map<std::string, std::string> seen;
    hdf5::Reader(path).contents(
        [&](const std::string& name, std::string_view bytes) { seen[name].append(bytes); });
    ASSERT_EQ(seen["motion"].size(), 1000U * 6 * 4);
    float last = 0;
    std::memcpy(&last, seen["motion"].data() + seen["motion"].size() - 4, 4);
    EXPECT_EQ(last, 5999 * 0.5F);
    EXPECT_EQ(seen["clip/label"], std::string("\x04\0\0\0\x05\0\0\0\x06\0\0\0", 12));
}

TEST_F(Contents, StaysWhenAnotherProgramOpensAndClosesTheFile) {
    if (!has_h5py()) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    const auto before = read_file(path);
    ASSERT_TRUE(python("pass"));
    EXPECT_NE(read_file(path).size(), before.size())
        << "h5py drops the padding: else this test shows nothing";
    EXPECT_EQ(read(), written);
}

TEST_F(Contents, TellsAnyChange) {
    if (!has_h5py()) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    const auto before = read_file(path);
    std::set<std::string> checksums{written};
    std::size_t changes = 0;
    for (const auto* change :
         {"f['motion'][999, 1, 2] += 1", "f['clip/label'][1] = 4", "f['clip/name'][0] = b'two'",
          "f['clip/name'][2] = b'x'", "f.attrs.modify('persons', 3)",
          "import numpy; f.attrs['program'] = numpy.bytes_('as nade')",
          "f.attrs.modify('bone_length', [0.5, 0.5])", "del f.attrs['empty']", "f.attrs.create('more', 1)",
          "f.move('motion', 'motions')", "f['clip'].attrs['note'] = 1", "f['motion'].attrs['note'] = 1",
          "f.create_group('more')", "del f['nothing']", "f.create_dataset('other', data=[1.0])"}) {
        write_file(path, before);
        ASSERT_TRUE(python(change));
        ++changes;
        checksums.insert(read());
        EXPECT_EQ(checksums.size(), changes + 1) << change;
    }
}

TEST_F(Contents, WhatNoWriterOfOursMakesIsNamed) {
    if (!has_h5py()) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    const auto before = read_file(path);
    for (const auto& [change, named] : {std::pair{"f.attrs['author'] = 'me'", "'author'"},
                                        {"f['texts'] = ['of', 'any', 'length']", "'texts'"},
                                        {"f['again'] = h5py.SoftLink('/motion')", "'again'"}}) {
        write_file(path, before);
        ASSERT_TRUE(python(change));
        try {
            read();
            ADD_FAILURE() << change << ": not refused";
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(named), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find("file.h5"), std::string::npos) << e.what();
        }
    }
}

TEST_F(Contents, GroupsFarDownAreRefusedBeforeTheyAreVisited) {
    {
        const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        hdf5::Handle last(H5Gopen2(file.get(), "clip", H5P_DEFAULT), H5Gclose);
        for (int i = 0; i < 40; ++i)
            last = hdf5::Handle(H5Gcreate2(last.get(), "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        ASSERT_GE(last.get(), 0);
    }
    try {
        read();
        FAIL() << "not refused";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("file.h5: 'clip/g/g"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("more than 32 parts"), std::string::npos) << e.what();
    }
}

TEST_F(Contents, AChunkThatIsNotWhatItsOwnChecksumSaysIsRefused) {
    auto bytes = read_file(path);
    const float number = 2000 * 0.5F;
    const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&number), 4));
    ASSERT_NE(at, std::string::npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write_file(path, bytes);
    try {
        read();
        FAIL() << "not refused";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("'motion'"), std::string::npos) << e.what();
    }
}
