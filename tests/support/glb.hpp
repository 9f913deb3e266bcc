// A .glb taken apart.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace actformer::test {

struct Glb {
    nlohmann::json json;
    std::string binary;

    std::vector<float> floats(std::size_t accessor) const { return numbers<float>(accessor, 5126); }

    /// `type` is glTF's number for T.
    template <typename T>
    std::vector<T> numbers(std::size_t accessor, int type) const {
        const auto& a = json["accessors"].at(accessor);
        EXPECT_EQ(a["componentType"], type);
        const auto& view = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
        std::vector<T> out(view["byteLength"].get<std::size_t>() / sizeof(T));
        EXPECT_LE(view["byteOffset"].get<std::size_t>() + out.size() * sizeof(T), binary.size());
        std::memcpy(out.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                    out.size() * sizeof(T));
        return out;
    }
};

inline std::uint32_t word(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

inline Glb parsed(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(bytes, 4), 2U);
    EXPECT_EQ(word(bytes, 8), bytes.size());
    const auto text = word(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(text % 4, 0U);
    const auto size = word(bytes, 20 + text);
    EXPECT_EQ(bytes.substr(24 + text, 4), std::string("BIN\0", 4));
    EXPECT_EQ(28 + text + size, bytes.size());
    return {nlohmann::json::parse(bytes.substr(20, text)), bytes.substr(28 + text)};
}

}  // namespace actformer::test
