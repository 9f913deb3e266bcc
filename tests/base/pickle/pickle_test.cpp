// Pickles as Python writes them in every protocol, joblib's files, and what neither would write.
#include "base/pickle/pickle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "base/files/mapped_file.hpp"
#include "tests/base/pickle/made_by_python.hpp"
#include "tests/support/paths.hpp"

using namespace actformer;
using namespace std::string_literals;

namespace {

namespace made = actformer::made_by_python;
namespace fs = std::filesystem;
using Numbers = std::vector<double>;
using Shape = std::vector<std::uint64_t>;

std::string bytes_of(std::string_view hex) {
    std::string out;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        out += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return out;
}

std::string fault(std::string_view bytes, const PickleLimits& limits = {}) {
    try {
        const Pickle pickle(bytes, limits);
        return "taken: " + pickle.root().what();
    } catch (const Error& e) {
        EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string_view::npos);
        return e.what();
    }
}

void expect_says(const std::string& message, std::string_view part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

/// A text behind its length, as one opcode has it.
std::string text(std::string_view bytes) {
    return "\x8C"s + static_cast<char>(bytes.size()) + std::string(bytes);
}

std::string type(std::string_view name) {
    return "cnumpy\ndtype\n" + text(name) + "K\0K\1\x87R(K\3"s + text("<") +
           "NNNJ\xFF\xFF\xFF\xFFJ\xFF\xFF\xFF\xFFK\0tb"s;
}

/// What joblib writes for an array: its description, and outside the pickle `padding` bytes and `numbers`.
std::string joblib_array(const std::string& shape, std::string_view type_name, unsigned padding,
                         const std::string& numbers) {
    return "cjoblib.numpy_pickle\nNumpyArrayWrapper\n)\x81}("s + text("subclass") + "cnumpy\nndarray\n" +
           text("shape") + shape + text("order") + text("C") + text("dtype") + type(type_name) +
           text("allow_mmap") + "\x88" + text("numpy_array_alignment_bytes") + "K\x10ub" +
           static_cast<char>(padding) + std::string(padding, '\xFF') + numbers;
}

std::string doubles(const Numbers& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size()};
}

/// As a NumPy array is written, of `shape` (an opcode or several) and `type_name`.
std::string array(const std::string& shape, std::string_view type_name, const std::string& numbers) {
    return "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\nK\0\x85"s + "C\1b\x87R(K\1"s + shape +
           type(type_name) + "\x89" + "C" + static_cast<char>(numbers.size()) + numbers + "tb";
}

class EveryProtocol : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryProtocol, GivesTheSameValues) {
    const auto bytes = bytes_of(GetParam());
    const Pickle pickle(bytes);
    const auto& root = pickle.root();
    const auto whole = root.get("whole");
    ASSERT_EQ(whole.size(), 8U);
    EXPECT_EQ(whole[1].whole(), -1);
    EXPECT_EQ(whole[2].whole(), 300);
    EXPECT_EQ(whole[3].whole(), std::int64_t{1} << 40);
    EXPECT_EQ(whole[4].whole(), -(std::int64_t{1} << 40));
    EXPECT_TRUE(whole[5].truth() && !whole[6].truth() && whole[7].is_none());
    EXPECT_EQ(root.get("real").real(), -1.5);
    EXPECT_EQ(root.get("text").text(), "h\u00e4nd");
    EXPECT_EQ(root.get("bytes").bytes(), "\x00\xFF\n"s);
    EXPECT_EQ(root.get("tuple")[1][1].text(), "a");
    EXPECT_EQ(root.get("empty").size(), 3U);
    EXPECT_EQ(root.get("set")[0].whole(), 7);
    EXPECT_EQ(root.get("number").real(), 2.5);
    EXPECT_EQ(root.get("count").whole(), -3);
    EXPECT_EQ(root.get("ordered").entry(0).first.text(), "z");
    EXPECT_EQ(root.get("ordered").get("a").whole(), 2);

    const auto& c = root.get("c").array();
    EXPECT_EQ(c.type, "<f4");
    EXPECT_EQ(c.shape, (Shape{2, 3}));
    EXPECT_EQ(c.all_numbers(), (Numbers{0, 1, 2, 3, 4, 5}));
    const auto& f = root.get("f").array();
    EXPECT_TRUE(f.fortran_order && f.big_endian);
    EXPECT_EQ(f.all_numbers(), (Numbers{0, 3, 1, 4, 2, 5}));
    EXPECT_EQ(root.get("i").array().all_numbers(), (Numbers{1, -2}));
    EXPECT_EQ(root.get("words").array().all_texts(), (std::vector<std::string>{"ab", "c"}));
}

INSTANTIATE_TEST_SUITE_P(Pickle, EveryProtocol,
                         testing::Values(made::protocol0, made::protocol1, made::protocol2, made::protocol3,
                                         made::protocol4, made::protocol5),
                         [](const auto& one) { return "protocol" + std::to_string(one.index); });

TEST(Pickle, CutShortAnywhereItIsRefused) {
    for (const auto hex :
         {made::protocol0, made::protocol2, made::protocol5, made::xz_stream, made::zlib_stream}) {
        const auto bytes = bytes_of(hex);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const std::vector<char> exact(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
            EXPECT_FALSE(fault({exact.data(), size}).starts_with("taken")) << size;
        }
    }
}

TEST(Pickle, ArraysAreViewsOfTheFile) {
    const auto bytes = bytes_of(made::protocol4);
    const Pickle pickle(bytes);
    const auto values = pickle.root().get("c").array().values;
    EXPECT_TRUE(values.data() > bytes.data() && values.data() + values.size() < bytes.data() + bytes.size());
}

TEST(Pickle, UnpacksWhatJoblibCompresses) {
    for (const auto hex : {made::zlib_stream, made::gzip_stream, made::bzip2_stream, made::xz_stream,
                           made::lzma_stream, made::zf_stream}) {
        const auto bytes = bytes_of(hex);
        EXPECT_EQ(Pickle(bytes).root().get("a").whole(), 1);
        PickleLimits limits;
        limits.unpacked = 5;
        expect_says(fault(bytes, limits), "the compressed file holds more than");
    }
}

TEST(Pickle, ReadsTheNumbersThatJoblibPutsBehindAnArray) {
    for (const unsigned padding : {0U, 1U, 15U}) {
        const auto bytes = "\x80\x04}("s + text("a") +
                           joblib_array("K\2K\1\x86", "f8", padding, doubles({1.5, -2})) + text("b") +
                           joblib_array("K\1\x85", "i4", padding, "\7\0\0\0"s) + "u.";
        const Pickle pickle(bytes);
        EXPECT_EQ(pickle.root().get("a").array().shape, (Shape{2, 1}));
        EXPECT_EQ(pickle.root().get("a").array().all_numbers(), (Numbers{1.5, -2}));
        EXPECT_EQ(pickle.root().get("b").array().all_numbers(), (Numbers{7}));
    }
    expect_says(fault(joblib_array("K\2K\1\x86", "f8", 3, doubles({1.5})) + "."), "cut short");
    expect_says(fault(joblib_array("K\1\x85", "O8", 3, doubles({1.5})) + "."), "an array of Python objects");
    expect_says(fault("cjoblib.numpy_pickle\nNDArrayWrapper\n)\x81."s), "in another file");
}

TEST(Pickle, ClassesOfModelFilesAreTheirAttributes) {
    const auto sparse = bytes_of(made::sparse);
    const Pickle matrix(sparse);
    EXPECT_TRUE(matrix.root().is_object("scipy.sparse._csc csc_matrix"));
    EXPECT_EQ(matrix.root().get("data").array().all_numbers(), (Numbers{1, 2, 3}));
    EXPECT_EQ(matrix.root().get("indices").array().all_numbers(), (Numbers{1, 0, 1}));
    EXPECT_EQ(matrix.root().get("_shape")[1].whole(), 3);

    // As Python 2 writes classes of its own in protocols 2 and 0.
    for (const auto& begun : {"cchumpy.ch\nCh\n)\x81"s,
                              "ccopy_reg\n_reconstructor\n(cchumpy.ch\nCh\nc__builtin__\nobject\nNtR"s}) {
        const auto bytes = begun + "}U\1xK\5sb.";
        const Pickle ch(bytes);
        EXPECT_TRUE(ch.root().is_object("chumpy.ch Ch"));
        EXPECT_FALSE(ch.root().is_object("chumpy.reordering Select"));
        EXPECT_EQ(ch.root().get("x").whole(), 5);
    }
}

TEST(Pickle, TextsOfPython2AreLatin1) {
    const auto spelled = "S'caf\\xe9 \\'\\n'\n."s, counted = "U\4caf\xE9."s;
    EXPECT_EQ(Pickle(spelled).root().text(), "caf\u00e9 '\n");
    EXPECT_EQ(Pickle(counted).root().text(), "caf\u00e9");
    EXPECT_EQ(Pickle(counted).root().bytes(), "caf\xE9");
}

TEST(Pickle, RunsNothingAndSaysWhatItWasAskedToRun) {
    expect_says(fault("\x80\x02(K\1cos\nsystem\n(S'id'\ntR."s), "os system at byte 5 ");
    expect_says(fault("\x80\x04"s + text("posix") + text("system") + "\x93" + text("id") + "\x85R."),
                "posix system at byte 17 ");
    expect_says(fault("(S'id'\nios\nsystem\n."s), "os system at byte 7 ");
    expect_says(fault("(cos\nsystem\nS'id'\no."s), "os system at byte 1 ");
    expect_says(fault("cbuiltins\neval\n."s), "builtins eval at byte 0 ");
    expect_says(fault("cos\nsys\x1B[2Jtem\n."s), "sys\\x1B[2Jtem");
    expect_says(fault("P1\n."s), "keeps elsewhere");
    expect_says(fault("\x82\1."s), "registry");
    expect_says(fault("\x97."s), "outside the file");
}

TEST(Pickle, AttributesAndCallsThatNoWriterMakesAreRefused) {
    expect_says(fault("}}b."s), "a dict with attributes");
    expect_says(fault("K\1)R."s), "the number 1 cannot be called");
    expect_says(fault("cnumpy\nndarray\n)R."s), "numpy ndarray is not called so");
    expect_says(fault("cnumpy.core.multiarray\n_reconstruct\nc__builtin__\nset\nK\0\x85"s + "C\1b\x87R."),
                "a class of its own");
    expect_says(fault("]K\1K\2s."s), "takes no such elements");
    expect_says(fault("cchumpy.ch\nCh\n)\x81K\1b."s), "for an object's attributes");
    expect_says(fault("(K\1d."s), "a key without a value");
}

TEST(Pickle, ArraysThatDoNotFitAreRefused) {
    EXPECT_TRUE(fault(array("K\2\x85", "f4", "12345678") + ".").starts_with("taken"));
    expect_says(fault(array("K\3\x85", "f4", "12345678") + "."), "an array of <f4 (3,) in 8 bytes");
    expect_says(fault(array("J\xFF\xFF\xFF\x7FJ\xFF\xFF\xFF\x7F\x86", "f8", "") + "."), "cannot hold");
    expect_says(fault(array("J\xFF\xFF\xFF\x7FJ\xFF\xFF\xFF\x7FJ\xFF\xFF\xFF\x7F\x87", "f8", "") + "."),
                "cannot hold");
    expect_says(fault(array("J\xFF\xFF\xFF\xFF\x85", "f8", "") + "."), "is no length of an axis");
    expect_says(fault(array("K\1\x85", "M8", "12345678") + "."), "holds no numbers");
    expect_says(fault(bytes_of(made::objects)), "an array of Python objects");
    expect_says(fault(bytes_of(made::fields)), "structured");
    expect_says(fault(bytes_of(made::huge)), "more than 64 bits");
}

TEST(Pickle, WhatIsMadeToExhaustIsRefused) {
    PickleLimits limits;
    limits.memory = 1 << 16;
    expect_says(fault(std::string(5000, ']') + ".", limits), "made to exhaust memory");
    expect_says(fault(std::string(600, '(') + "."), "nested too deep");
    expect_says(fault(")" + std::string(600, '\x85') + "."), "nested too deep");
    expect_says(fault("Nr\xFF\xFF\xFF\x7F."s), "in a memo of 0");
    expect_says(fault("h\5."s), "nothing at place 5");
    // One text of a hundred numbers, as the numbers of array upon array.
    std::string many = "(B" + "\x90\1\0\0"s + std::string(400, 'x') + "\x94" + type("f4") + "\x94";
    for (int i = 0; i < 40; ++i)
        many += "cnumpy.core.numeric\n_frombuffer\n(h\0h\1Kd\x85"s + text("C") + "tR";
    expect_says(fault(many + "t."), "made to exhaust its readers");
}

TEST(Pickle, AListInItselfIsRead) {
    const auto bytes = "]\x94h\0a."s;
    const Pickle pickle(bytes);
    EXPECT_EQ(pickle.root()[0][0][0].size(), 1U);
}

TEST(Pickle, OtherFilesAreToldApart) {
    expect_says(fault(""), "empty");
    expect_says(fault("\n<!DOCTYPE HTML>\n<html>"), "an HTML page in place of a pickle");
    expect_says(fault("\0\0\0"s), "0x00 is no opcode");
    expect_says(fault("\x80\x06."s), "protocol 6");
    expect_says(fault("."s), "nothing on the stack");
    expect_says(fault("x\x9C is no zlib"s), "damaged or cut short");
}

TEST(Pickle, ValuesSayWhereTheyAreNotAsWanted) {
    const auto bytes = "\x80\x02}(U\1aK\1U\1b]u."s;
    const Pickle pickle(bytes);
    const auto says = [](auto use, std::string_view part) {
        try {
            use();
            ADD_FAILURE();
        } catch (const Error& e) {
            expect_says(e.what(), part);
        }
    };
    says([&] { pickle.root().get("pose"); }, "byte 2: a dict without 'pose'; it has 'a', 'b'");
    says([&] { pickle.root().get("a").array(); }, "byte 7: the number 1, not an array");
    says([&] { pickle.root().get("b")[0]; }, "byte 12: a list of 0");
    says([&] { pickle.root().get("b").get("x"); }, "a list, not a dict");
    says([&] { pickle.root().get("b").text(); }, "not a text");
    EXPECT_FALSE(pickle.root().find("c"));
    EXPECT_FALSE(pickle.root().find(1));
}

/// Every sample, whoever made it: arrays of the file, and as many as Python found.
TEST(Pickle, ReadsTheSamples) {
    const fs::path samples = test::shared("data/raw_format_samples");
    if (!fs::exists(samples)) GTEST_SKIP() << "needs " << samples.string();
    const MappedFile ntu(samples / "ntu13/ntu_vibe/S001C001P001R001A099.pkl"),
        packed(samples / "ntu13/ntu_vibe/S001C001P004R001A080.pkl"),
        uestc(samples / "uestc/vibe_cache_refined.pkl"),
        act12(samples / "humanact12/HumanAct12Poses/humanact12poses.pkl"),
        smpl(samples / "smpl_toy/toy_chumpy_py2.pkl");
    for (const auto* file : {&ntu, &packed}) {
        const Pickle pickle(file->text());
        const auto person = pickle.root().find(1);
        ASSERT_TRUE(person);
        EXPECT_EQ(person->get("pose").array().shape[1], 72U);
        EXPECT_EQ(person->get("joints3d").array().shape[1], 49U);
    }
    EXPECT_EQ(Pickle(uestc.text()).root().get("pose").size(), 12U);
    EXPECT_EQ(Pickle(act12.text()).root().get("y").size(), 10U);
    const Pickle body(smpl.text());
    EXPECT_TRUE(body.root().get("J_regressor").is_object("scipy.sparse.csc csc_matrix"));
    EXPECT_TRUE(body.root().get("shapedirs").is_object("chumpy.ch Ch"));
    EXPECT_TRUE(body.root().get("shapedirs").get("x").is_array());
    EXPECT_TRUE(body.root().get("posedirs").array().fortran_order);
}

}  // namespace
