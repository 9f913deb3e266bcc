// Checksums that stand in their own file or object: any changed byte is told, and what has none is left alone.
#include "base/checksum/own_checksum.hpp"

#include <gtest/gtest.h>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
using Json = nlohmann::ordered_json;

namespace {

struct OwnFile : testing::Test {
    TempDir dir;
    std::filesystem::path path = dir / "file.h5";

    OwnFile() {
        hdf5::Writer writer(path);
        writer.write<float>("numbers", {3}, std::vector<float>{1, 2, 3});
        writer.attribute("note", std::string("as made"));
        writer.finish();
    }
    std::vector<float> numbers() const { return hdf5::Reader(path).read<float>("numbers"); }
};

}  // namespace

TEST(OwnChecksum, IsOfAllThatStandsBeforeIt) {
    const std::string text = "some bytes", line = checksum_line(text);
    EXPECT_EQ(own_checksum(text), OwnChecksum::absent);
    EXPECT_EQ(own_checksum(""), OwnChecksum::absent);
    EXPECT_EQ(own_checksum(text + line), OwnChecksum::right);
    EXPECT_EQ(own_checksum(checksum_line("")), OwnChecksum::right);
    EXPECT_EQ(own_checksum(text + "!" + line), OwnChecksum::wrong);
    EXPECT_EQ(own_checksum(line), OwnChecksum::wrong);
    EXPECT_EQ(own_checksum(line.substr(1)), OwnChecksum::absent);
    EXPECT_EQ(own_checksum(text + line.substr(1)), OwnChecksum::wrong) << "a character is missing";
    for (std::size_t at = 0; at < line.size(); ++at) {
        auto damaged = line;
        damaged[at] = static_cast<char>(damaged[at] ^ 1);
        EXPECT_EQ(own_checksum(text + damaged), OwnChecksum::wrong) << at;
    }
    EXPECT_EQ(own_checksum(text + line + "more"), OwnChecksum::absent);
}

TEST(OwnChecksum, OfAFileIsThatOfItsBytes) {
    const TempDir dir;
    const std::string large(std::size_t{3} << 20, 'x');  // several pieces
    for (const auto& text : {std::string(), std::string("short"), large, large.substr(0, (1 << 20) - 20)}) {
        const auto path = dir / "file";
        write_file(path, text);
        EXPECT_EQ(own_checksum_of_file(path), OwnChecksum::absent);
        write_file(path, text + checksum_line(text));
        EXPECT_EQ(own_checksum_of_file(path), OwnChecksum::right);
        if (text.empty()) continue;
        auto bytes = read_file(path);
        bytes[text.size() - 1] = '!';
        write_file(path, bytes);
        EXPECT_EQ(own_checksum_of_file(path), OwnChecksum::wrong);
    }
}

TEST_F(OwnFile, AnyFlippedBitIsTold) {
    const auto whole = read_file(path);
    ASSERT_EQ(own_checksum(whole), OwnChecksum::right);
    for (std::size_t at = 0; at < whole.size(); at += 7) {
        auto bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
        write_file(path, bytes);
        const auto why = error_of([&] { numbers(); });
        EXPECT_NE(why.find("file.h5: damaged"), std::string::npos) << at << ": " << why;
    }
}

TEST_F(OwnFile, AFileCutShortIsTold) {
    const auto whole = read_file(path);
    for (const std::size_t size : {whole.size() - 1, whole.size() - 50, whole.size() / 2, std::size_t{0}}) {
        write_file(path, whole.substr(0, size));
        EXPECT_NE(error_of([&] { numbers(); }).find("file.h5: "), std::string::npos) << size;
    }
    const std::string shortest = "\nchecksum ";
    for (auto size = whole.size() - checksum_line("").size() + shortest.size(); size < whole.size(); ++size) {
        write_file(path, whole.substr(0, size));
        EXPECT_NE(error_of([&] { numbers(); }).find("file.h5: damaged"), std::string::npos) << size;
    }
}

TEST_F(OwnFile, OneThatThisProgramWroteIsRefusedWithoutItsChecksum) {
    const auto error_without = [&](const std::function<void(hdf5::Writer&)>& note) {
        hdf5::Writer file(path);
        file.write<float>("numbers", {3}, std::vector<float>{1, 2, 3});
        note(file);
        file.finish();
        const auto whole = read_file(path),
                   without = whole.substr(0, whole.size() - checksum_line("").size());
        write_file(path, without);
        const auto why = error_of([&] { numbers(); });
        const auto in_memory = error_of([&] { hdf5::Reader(without, "in memory"); });
        EXPECT_EQ(in_memory.empty(), why.empty()) << in_memory;
        write_file(path, whole);
        EXPECT_EQ(numbers(), (std::vector<float>{1, 2, 3}));
        return why;
    };
    const auto by = [](const char* program) {
        return [program](hdf5::Writer& file) { file.attribute("program", std::string(program)); };
    };
    const auto why = error_without(by("actformer 0.1.0"));
    EXPECT_NE(why.find("file.h5: damaged: its checksum is missing"), std::string::npos) << why;
    EXPECT_NE(why.find("remove its attribute 'program'"), std::string::npos) << why;
    EXPECT_EQ(error_without(by("actformer, the Python package")), "");
    EXPECT_EQ(error_without(by("another")), "");
    EXPECT_EQ(
        error_without([](hdf5::Writer& file) { file.attribute("program", std::vector<std::int64_t>{7}); }),
        "");
    EXPECT_EQ(error_without([&](hdf5::Writer& file) {
                  by("actformer 0.1.0")(file);
                  file.attribute("dataset", std::string("a shard's"));
              }),
              "")
        << "its checksum stands in dataset.json";
}

TEST_F(OwnFile, OneThatAnotherProgramChangedIsReadAsItIs) {
    if (!python_has("h5py")) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    const auto python = [&](const std::string& lines) {
        return run_command("/usr/bin/python3 -c \"import h5py; " + lines + "\" " + path.string());
    };
    const auto read = python("import sys; print(h5py.File(sys.argv[1])['numbers'][:].tolist())");
    EXPECT_NE(read.output.find("1.0, 2.0, 3.0"), std::string::npos) << read.output;
    ASSERT_EQ(python("import sys; h5py.File(sys.argv[1], 'r+').attrs['author'] = 'me'").exit, 0);
    EXPECT_EQ(own_checksum_of_file(path), OwnChecksum::absent) << "HDF5 drops what stands behind its file";
    EXPECT_EQ(numbers(), (std::vector<float>{1, 2, 3}));
    EXPECT_TRUE(hdf5::Reader(path).has_attribute("author"));
}

TEST(CheckedJson, TellsAnyOtherMemberAndNoOtherSpacesOrOrder) {
    const Json object{{"name", "ntu"}, {"fps", 30.0}, {"list", {1, 2, {{"deep", nullptr}}}}};
    EXPECT_EQ(own_checksum_of(object), OwnChecksum::absent);
    EXPECT_EQ(own_checksum_of(Json::array({1})), OwnChecksum::absent);
    const auto checked = with_checksum(object);
    EXPECT_EQ(own_checksum_of(checked), OwnChecksum::right);
    EXPECT_EQ(own_checksum_of(with_checksum(checked)), OwnChecksum::right);
    EXPECT_EQ(with_checksum(checked), checked);
    EXPECT_EQ(own_checksum_of(Json::parse(checked.dump(4))), OwnChecksum::right);
    EXPECT_EQ(own_checksum_of(Json::parse(nlohmann::json(checked).dump())), OwnChecksum::right)
        << "sorted by name";
    auto other = checked;
    other["list"][2]["deep"] = 0;
    EXPECT_EQ(own_checksum_of(other), OwnChecksum::wrong);
    other = checked;
    other["checksum"] = 7;
    EXPECT_EQ(own_checksum_of(other), OwnChecksum::wrong);
    other = checked;
    other["more"] = 1;
    EXPECT_EQ(own_checksum_of(other), OwnChecksum::wrong);
}

TEST(CheckedJson, OneThatThisProgramWroteHasAChecksum) {
    for (const auto& [program, said] : {std::pair{Json("actformer 0.1.0"), OwnChecksum::wrong},
                                        {"actformer, the Python package", OwnChecksum::absent},
                                        {"actformer ", OwnChecksum::absent},
                                        {7, OwnChecksum::absent}}) {
        Json object{{"program", program}, {"fps", 30}};
        EXPECT_EQ(own_checksum_of(object), said) << program;
        EXPECT_EQ(own_checksum_of(with_checksum(object)), OwnChecksum::right) << program;
    }
}
