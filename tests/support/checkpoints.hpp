// Checkpoints of trainings, compared.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "model/train/checkpoint.hpp"

namespace actformer::test {

/// Name of the newest checkpoint.
inline std::string newest(const std::filesystem::path& run) {
    std::string name;
    for (const auto& entry : std::filesystem::directory_iterator(run))
        if (entry.path().filename().string().starts_with("checkpoint-"))
            name = std::max(name, entry.path().filename().string());
    return name;
}

/// Every array's numbers by name.
inline auto numbers_of(const std::filesystem::path& file) {
    std::map<std::string, decltype(model::Array::values)> numbers;
    const auto checkpoint = model::read_checkpoint(file).value();
    for (const auto& array : checkpoint.arrays) numbers[array.name] = array.values;
    return numbers;
}

/// To the bit, the time they took apart.
inline void expect_same_checkpoint(const std::filesystem::path& one, const std::filesystem::path& other) {
    auto a = model::read_checkpoint(one).value(), b = model::read_checkpoint(other).value();
    for (auto* checkpoint : {&a, &b}) checkpoint->state.erase("seconds");
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(numbers_of(one), numbers_of(other)) << one << ", " << other;
}

}  // namespace actformer::test
