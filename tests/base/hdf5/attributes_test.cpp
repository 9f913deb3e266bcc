// Attributes as h5py writes them.
#include <gtest/gtest.h>

#include <cstring>

#include "base/error.hpp"
#include "base/hdf5/attribute_bytes.hpp"
#include "base/hdf5/reader.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

using Texts = std::vector<std::string>;

struct AttributesOfH5py : testing::Test {
    TempDir dir;
    std::filesystem::path path = dir / "file.h5";

    void SetUp() override {
        static const bool has_h5py = python_has("h5py");
        if (!has_h5py) GTEST_SKIP() << "no h5py in /usr/bin/python3 (Debian: python3-h5py)";
    }

    /// Runs `script` with `f` open to write; whether it could.
    bool write(const std::string& script, const std::string& how = "") const {
        write_file(dir / "make.py", "import h5py, numpy\nwith h5py.File('" + path.string() + "', 'w'" + how +
                                        ") as f:\n" + script);
        return run_command("/usr/bin/python3 " + (dir / "make.py").string()).exit == 0;
    }
};

/// Whether attribute `names` of the object at `header` is found, and its texts.
bool texts_past_the_library(const std::string& bytes, std::uint64_t header) {
    const auto file = [&](std::uint64_t offset, std::uint64_t size) {
        return offset < bytes.size() ? bytes.substr(offset, size) : std::string();
    };
    const auto references = hdf5::attribute_bytes(header, "names", file);
    Texts texts;
    return references && hdf5::read_variable_texts(*references, file, bytes.size(), texts);
}

std::string refusal_of(const hdf5::Reader& file, const std::string& name) {
    try {
        file.attribute_texts(name);
    } catch (const Error& e) {
        return e.what();
    }
    return "not refused";
}

}  // namespace

TEST_F(AttributesOfH5py, AreReadAsTheyUsuallyAre) {
    const std::string script = R"(
    f.attrs['representation'] = 'xyz'
    f.attrs['names'] = ['hips', '', 'gen\u00f6u']
    f.attrs['fixed'] = numpy.bytes_('xyz')
    f.attrs['fps'] = 30
    f.attrs['rate'] = 29.5
    f['a'] = numpy.zeros(3)
    f['a'].attrs['of'] = 'an array'
    f['a'].attrs['fps'] = [1, 2]
)";
    for (const std::string how : {"", ", libver='latest'", ", track_order=True"}) {
        ASSERT_TRUE(write(script, how));
        for (const auto& file : {hdf5::Reader(path), hdf5::Reader(read_file(path), "in memory")}) {
            EXPECT_EQ(file.attribute_texts("representation"), Texts{"xyz"});
            EXPECT_EQ(file.attribute_texts("names"), (Texts{"hips", "", "gen\xC3\xB6u"}));
            EXPECT_EQ(file.attribute_texts("fixed"), Texts{"xyz"});
            EXPECT_EQ(file.attribute_texts("of", "a"), Texts{"an array"});
            EXPECT_EQ(file.attribute_floats("fps"), std::vector<float>{30});
            EXPECT_EQ(file.attribute_floats("rate"), std::vector<float>{29.5});
            EXPECT_EQ(file.attribute_floats("fps", "a"), (std::vector<float>{1, 2}));
        }
    }
}

TEST_F(AttributesOfH5py, OfWhichThereAreManyAreReadOrTheRemedyIsTold) {
    const std::string script = "    for i in range(200): f.attrs[f'text {i}'] = f'number {i}'\n";
    ASSERT_TRUE(write(script));
    for (const int i : {0, 7, 100, 199})
        EXPECT_EQ(hdf5::Reader(path).attribute_texts(fmt::format("text {}", i)),
                  Texts{fmt::format("number {}", i)});
    ASSERT_TRUE(write(script, ", libver='latest'"));
    const auto why = refusal_of(hdf5::Reader(path), "text 7");
    EXPECT_NE(why.find("attribute 'text 7' holds text of variable length"), std::string::npos) << why;
    EXPECT_NE(why.find("numpy.bytes_"), std::string::npos) << why;
}

TEST_F(AttributesOfH5py, ThatAreDamagedAreRefused) {
    ASSERT_TRUE(write("    f.attrs['names'] = ['" + std::string(1000, 'x') + "', 'y']\n"));
    const auto whole = read_file(path);
    const std::uint32_t length = 1000;
    for (const std::uint32_t other : {0x70000000U, 4000000U}) {
        auto bytes = whole;
        for (std::size_t at = 0; at + 4 <= bytes.size(); ++at)
            if (std::memcmp(&bytes[at], &length, 4) == 0) std::memcpy(&bytes[at], &other, 4);
        EXPECT_NE(refusal_of(hdf5::Reader(bytes, "in memory"), "names").find("damaged"), std::string::npos);
    }
    // Whatever a byte is, ours is an answer; the library's own reading of damaged headers has faults, and is left out.
    std::uint64_t root = 0;
    std::memcpy(&root, &whole[64], sizeof root);  // of a superblock of version 0
    ASSERT_TRUE(texts_past_the_library(whole, root));
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int change : {0x01, 0x80, 0xFF}) {
            auto bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ change);
            texts_past_the_library(bytes, root);
        }
}
