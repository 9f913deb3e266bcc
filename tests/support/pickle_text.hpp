// Pickles as Python 3 writes them, for tests that make their own.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace actformer::test::pickled {

inline std::string four(std::size_t count) {
    const auto word = static_cast<std::uint32_t>(count);
    std::string out(4, '\0');
    std::memcpy(out.data(), &word, 4);
    return out;
}

inline std::string text(const std::string& utf8) {
    return "X" + four(utf8.size()) + utf8;
}

inline std::string whole(std::int32_t number) {
    return "J" + four(static_cast<std::uint32_t>(number));
}

/// Doubles of an array in C's order.
inline std::string array(const std::vector<std::size_t>& shape, const std::vector<double>& numbers) {
    std::string out = "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n" + whole(0) + "\x85" + "C" +
                      '\1' + "b\x87R(" + whole(1) + "(";
    for (const auto n : shape) out += whole(static_cast<std::int32_t>(n));
    out += "tcnumpy\ndtype\n" + text("f8") + "\x89\x88\x87R(" + whole(3) + text("<") + "NNN" + whole(-1) +
           whole(-1) + whole(0) + "tb\x89" + "B" + four(8 * numbers.size());
    out.append(reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size());
    return out + "tb";
}

inline std::string list(const std::vector<std::string>& values) {
    std::string out = "](";
    for (const auto& value : values) out += value;
    return out + "e";
}

inline std::string dict(const std::vector<std::pair<std::string, std::string>>& entries) {
    std::string out = "}(";
    for (const auto& [key, value] : entries) out += text(key) + value;
    return out + "u";
}

inline std::string file(const std::string& value) {
    return "\x80\x03" + value + ".";
}

}  // namespace actformer::test::pickled
