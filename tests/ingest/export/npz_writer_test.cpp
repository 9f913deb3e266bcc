// What is written as .npz, as NumPy reads it.
#include "ingest/export/npz/npz_writer.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;

bool has_numpy() {
    return python_has("numpy");
}

/// What Python says of `file`, called f in `code`, with NumPy and its zip archive z.
std::string python(const std::filesystem::path& file, const std::string& code, const TempDir& dir) {
    write_file(dir / "look.py",
               fmt::format("import numpy, zipfile\nz = zipfile.ZipFile('{0}')\nassert z.testzip() is None\n"
                           "f = numpy.load('{0}')\n{1}\n",
                           file.string(), code));
    return run_command("/usr/bin/python3 " + (dir / "look.py").string()).output;
}

TEST(NpzWriter, NumpyReadsItWithoutPickles) {
    if (!has_numpy()) GTEST_SKIP() << "Debian's python3-numpy is not here";
    const TempDir dir;
    NpzWriter writer(dir / "a.npz");
    std::vector<float> values(24);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) / 3;
    writer.add("a clip", {2, 2, 2, 3}, std::span<const float>(values));
    writer.add("fps", {}, std::span<const double>(std::vector<double>{29.97}));
    writer.add("labels", {3}, std::span<const std::int64_t>(std::vector<std::int64_t>{-1, 0, 7}));
    writer.add("names", {"left hip", "", "p\xC3\xA4\xF0\x9F\x92\x83", "\xFF"});
    writer.add("none", std::vector<std::string>{});
    writer.finish();
    EXPECT_EQ(
        python(
            dir / "a.npz",
            "print(sorted(f))\n"
            "a = f['a clip']\n"
            "print(a.shape, a.dtype, (a.ravel() == numpy.arange(24, dtype='f4') / numpy.float32(3)).all())\n"
            "print(f['fps'].shape, float(f['fps']), f['labels'].tolist(), f['labels'].dtype)\n"
            "print([ascii(str(t)) for t in f['names']], f['none'].shape)",
            dir),
        "['a clip', 'fps', 'labels', 'names', 'none']\n"
        "(2, 2, 2, 3) float32 True\n"
        "() 29.97 [-1, 0, 7] int64\n"
        "[\"'left hip'\", \"''\", \"'p\\\\xe4\\\\U0001f483'\", \"'\\\\\\\\xFF'\"] (0,)\n");
}

TEST(NpzWriter, SameArraysGiveSameBytes) {
    const TempDir dir;
    for (const char* name : {"a.npz", "b.npz"}) {
        NpzWriter writer(dir / name);
        writer.add("names", std::vector<std::string>{"x", "y"});
        writer.finish();
    }
    EXPECT_EQ(read_file(dir / "a.npz"), read_file(dir / "b.npz"));
}

TEST(NpzWriter, AFullDiskIsSeen) {
    NpzWriter writer("/dev/full");
    writer.add("names", std::vector<std::string>{"x", "y"});
    EXPECT_NE(error_of([&] { writer.finish(); }).find("/dev/full: cannot be written: No space left"),
              std::string::npos);
}

TEST(ZipWriter, MoreThan65535MembersTakeZip64) {
    if (!has_numpy()) GTEST_SKIP() << "Debian's python3-numpy is not here";
    const TempDir dir;
    ZipWriter writer(dir / "many.npz");
    for (int i = 0; i < 70000; ++i) {
        const auto text = std::to_string(i);
        const std::string_view parts[] = {text};
        writer.add(text, parts);
    }
    writer.finish();
    EXPECT_EQ(python(dir / "many.npz", "print(len(z.namelist()), z.read('69999'))", dir), "70000 b'69999'\n");
}

TEST(ZipWriter, MembersAndPlacesBeyond4GiBTakeZip64) {
    if (!std::getenv("ACTFORMER_LARGE_FILES")) GTEST_SKIP() << "writes 4 GiB: set ACTFORMER_LARGE_FILES=1";
    if (!has_numpy()) GTEST_SKIP() << "Debian's python3-numpy is not here";
    const TempDir dir;
    ZipWriter writer(dir / "large.npz");
    const std::string megabyte(1 << 20, '\0');
    const std::vector<std::string_view> parts((std::size_t{4} << 10) + 1, megabyte);
    writer.add("large", parts);
    const std::string_view few[] = {"end"};
    writer.add("behind", few);
    writer.finish();
    EXPECT_EQ(run_command("/usr/bin/python3 -c \"import zipfile; z = zipfile.ZipFile('" +
                          (dir / "large.npz").string() +
                          "'); print(z.getinfo('large').file_size, z.getinfo('behind').header_offset > "
                          "2**32, z.read('behind'))\"")
                  .output,
              "4296015872 True b'end'\n");
}

}  // namespace
}  // namespace actformer::ingest
