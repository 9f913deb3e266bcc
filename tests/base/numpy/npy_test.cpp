// NumPy arrays as NumPy writes them, and as it does not.
#include "base/numpy/npy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"
#include "tests/support/arrays.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

std::string fault(const std::string& bytes) {
    try {
        read_npy(bytes);
        return "taken";
    } catch (const Error& e) {
        return e.what();
    }
}

std::string npz_fault(const std::string& bytes) {
    try {
        read_npz(bytes, {}, [](auto&, auto&) {});
        return "taken";
    } catch (const Error& e) {
        return e.what();
    }
}

std::vector<double> numbers(const std::string& bytes) {
    return read_npy(bytes).all_numbers();
}

template <typename T>
std::string bytes_of(std::vector<T> values, bool swapped = false) {
    std::string out(values.size() * sizeof(T), '\0');
    std::memcpy(out.data(), values.data(), out.size());
    if (swapped)
        for (std::size_t i = 0; i < out.size(); i += sizeof(T))
            std::reverse(out.begin() + static_cast<std::ptrdiff_t>(i),
                         out.begin() + static_cast<std::ptrdiff_t>(i + sizeof(T)));
    return out;
}

using Doubles = std::vector<double>;

}  // namespace

TEST(Npy, ReadsNumbersOfEveryKind) {
    EXPECT_EQ(numbers(npy("<f4", "(2,)", bytes_of<float>({1.5F, -2}))), (Doubles{1.5, -2}));
    EXPECT_EQ(numbers(npy(">f4", "(2,)", bytes_of<float>({1.5F, -2}, true))), (Doubles{1.5, -2}));
    EXPECT_EQ(numbers(npy("<f8", "(2,)", bytes_of<double>({0.1, -2}))), (Doubles{0.1, -2}));
    EXPECT_EQ(numbers(npy(">f8", "(2,)", bytes_of<double>({0.1, -2}, true))), (Doubles{0.1, -2}));
    EXPECT_EQ(numbers(npy("<i2", "(2,)", bytes_of<std::int16_t>({-3, 300}))), (Doubles{-3, 300}));
    EXPECT_EQ(numbers(npy(">i8", "(1,)", bytes_of<std::int64_t>({-3}, true))), (Doubles{-3}));
    EXPECT_EQ(numbers(npy("|u1", "(2,)", bytes_of<std::uint8_t>({0, 255}))), (Doubles{0, 255}));
    EXPECT_EQ(numbers(npy("|i1", "(1,)", bytes_of<std::int8_t>({-1}))), (Doubles{-1}));
    EXPECT_EQ(numbers(npy("<u4", "(1,)", bytes_of<std::uint32_t>({4000000000U}))), (Doubles{4e9}));
    EXPECT_EQ(numbers(npy("|b1", "(2,)", bytes_of<std::uint8_t>({1, 0}))), (Doubles{1, 0}));
    EXPECT_EQ(numbers(npy("<f8", "()", bytes_of<double>({7}))), (Doubles{7}));
    // 1, -2, the smallest and the largest binary16, infinity and no number
    const auto half =
        numbers(npy("<f2", "(6,)", bytes_of<std::uint16_t>({0x3C00, 0xC000, 1, 0x7BFF, 0x7C00, 0x7E00})));
    EXPECT_EQ(Doubles(half.begin(), half.begin() + 4), (Doubles{1, -2, std::ldexp(1, -24), 65504}));
    EXPECT_TRUE(std::isinf(half[4]) && std::isnan(half[5]));
    EXPECT_EQ(
        read_npy(npy("<U3", "(2,)", std::string("a\0\0\0b\0\0\0\0\0\0\0\xe9\0\0\0\0\0\0\0\0\0\0\0", 24)))
            .all_texts(),
        (std::vector<std::string>{"ab", "\xC3\xA9"}));
    EXPECT_EQ(read_npy(npy("|S2", "(2,)", std::string("xyz\0", 4))).all_texts(),
              (std::vector<std::string>{"xy", "z"}));
}

TEST(Npy, ReadsHeadersOfEveryVersion) {
    for (const int version : {1, 2, 3}) {
        const auto array = read_npy(npy("<f4", "(1, 2)", bytes_of<float>({1, 2}), true, version));
        EXPECT_EQ(array.shape_text(), "(1, 2)");
        EXPECT_TRUE(array.fortran_order);
    }
    // As Python 2 wrote them, and in another order
    const std::string old = "{\"shape\": (2L,), 'fortran_order': False, 'descr': '<f4'}";
    EXPECT_EQ(numbers(npy_with_header(old, bytes_of<float>({1, 2}))), (Doubles{1, 2}));
}

TEST(Npy, RefusesWhatIsDamagedOrHostile) {
    const auto sound = npy("<f4", "(2, 3)", std::string(24, '\0'));
    for (std::size_t cut = 0; cut < sound.size(); ++cut)
        EXPECT_NE(fault(sound.substr(0, cut)), "taken") << cut;
    EXPECT_EQ(fault(sound + "x"), "1 bytes behind the last number of (2, 3) <f4");
    EXPECT_EQ(fault(sound.substr(0, sound.size() - 1)),
              "(2, 3) <f4 numbers do not fit into 23 bytes: cut short");
    EXPECT_EQ(fault("<html>"), "not a NumPy array: it does not begin with \\x93NUMPY");
    EXPECT_EQ(fault(npy("|O", "(2,)", "\x80\x02]q")).substr(0, 27), "an array of Python objects,");
    EXPECT_EQ(
        fault(npy_with_header("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (1,)}", "0000"))
            .substr(0, 18),
        "a structured array");
    EXPECT_NE(fault(npy("<f4", "(4294967296, 4294967296, 4)", "0000")).find("cut short"), std::string::npos);
    EXPECT_NE(fault(npy("<f4", "(9223372036854775807,)", "0000")).find("cut short"), std::string::npos);
    EXPECT_NE(fault(npy("<f4", "(99999999999999999999999,)", "0000")).find("damaged"), std::string::npos);
    for (const char* header :
         {"", "{", "{'descr': '<f4'}", "{'descr': '<f4', 'fortran_order': Maybe, 'shape': ()}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
          "{'descr': 'f4', 'fortran_order': False, 'shape': ()}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': 7}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (), 'x': 1}"})
        EXPECT_NE(fault(npy_with_header(header, "0000")).find("damaged"), std::string::npos) << header;
    auto version = sound;
    version[6] = 4;
    EXPECT_EQ(fault(version), "NumPy format version 4; 1 to 3 are known");
    EXPECT_THROW(read_npy(npy("<c8", "(1,)", "00000000")).all_numbers(), Error) << "complex numbers";
}

TEST(Npy, RefusesTextsOfWhatIsNoCharacter) {
    const auto texts = [](std::uint32_t last) {
        return read_npy(npy("<U2", "(1,)", bytes_of<std::uint32_t>({0x20AC, last}))).all_texts();
    };
    EXPECT_EQ(texts(0x10FFFF), (std::vector<std::string>{"\xE2\x82\xAC\xF4\x8F\xBF\xBF"}));
    EXPECT_THROW(texts(0x110000), Error);
    EXPECT_THROW(texts(0xFFFFFFFF), Error);
}

TEST(Npz, ReadsWhatNumPyWrites) {
    if (!python_has("numpy")) GTEST_SKIP() << "NumPy is not at hand";
    const TempDir dir;
    const auto made = run_command("cd " + dir.path().string() +
                                  " && /usr/bin/python3 -c \"import numpy as np\n"
                                  "a = np.arange(6, dtype='f4').reshape(1, 2, 3)\n"
                                  "np.savez('stored.npz', a=a, names=np.array(['x', 'yz']))\n"
                                  "np.savez_compressed('deflated.npz', a=a, b=np.asfortranarray(a))\n"
                                  "np.savez('objects.npz', a=np.array([{}], dtype=object))\"");
    ASSERT_EQ(made.exit, 0) << made.output;
    for (const std::string name : {"stored.npz", "deflated.npz"}) {
        const auto bytes = read_file(dir / name);
        for (const bool heads : {false, true}) {
            std::vector<std::string> seen;
            read_npz(bytes, {.heads_only = heads}, [&](const std::string& key, const NumpyArray& array) {
                seen.push_back(key + array.shape_text());
                if (key == "a") {
                    EXPECT_EQ(array.all_numbers(), (Doubles{0, 1, 2, 3, 4, 5}));
                }
                if (key == "b") {
                    EXPECT_TRUE(array.fortran_order);
                }
                if (key == "names") {
                    EXPECT_EQ(array.all_texts(), (std::vector<std::string>{"x", "yz"}));
                }
            });
            EXPECT_EQ(seen, name == "stored.npz" ? (std::vector<std::string>{"a(1, 2, 3)", "names(2,)"})
                                                 : (std::vector<std::string>{"a(1, 2, 3)", "b(1, 2, 3)"}));
        }
        for (std::size_t cut = 1; cut < bytes.size(); cut += 7)
            EXPECT_NE(npz_fault(bytes.substr(0, cut)), "taken") << name << " " << cut;
        auto damaged = bytes;
        damaged[bytes.find("NUMPY") == std::string::npos ? 60 : bytes.find("NUMPY") + 130] ^= 0x55;
        EXPECT_NE(npz_fault(damaged), "taken") << name;
    }
    EXPECT_EQ(npz_fault(read_file(dir / "objects.npz")).substr(0, 32), "'a': an array of Python objects,");
    EXPECT_NE(npz_fault("no archive"), "taken");
}

// What a file says for a type goes into messages of one line.
TEST(Npy, ATypeIsPrintableAndShort) {
    NumpyArray array;
    ASSERT_TRUE(array.take_type("<f4\n\x01" + std::string(1000, 'x')));
    EXPECT_EQ(array.type, "<f4\\x0A\\x01" + std::string(35, 'x'));
}
