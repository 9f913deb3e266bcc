// From a generator's weights to a file of motions in the public layout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace actformer::model {

struct GenerateRequest {
    std::filesystem::path generator, out;  ///< see load_generator
    std::uint32_t per_class = 100;
    std::vector<std::string> classes;  ///< numbers from 1, or names; empty: all
    std::uint64_t seed = 0;
    std::uint32_t frames = 0;  ///< 0: as many as it was trained on
    std::string device = "cpu";
    int threads = 0;  ///< 0: as many as the process may use
};

struct GenerateSummary {
    std::uint64_t motions = 0;
    std::uint32_t classes = 0, persons = 0, numbers = 0, nodes = 0, frames = 0;
};

/// Writes motions A001_0, A001_1, ... of every class, and as attributes whose motions they are and where they come from. The
/// file appears whole or not at all. The same seed gives the same bytes; motion i of a class is the same whatever else is
/// asked for. Throws Error for weights as load_generator says, a class out of range or given twice, and more frames than
/// the generator was made for.
GenerateSummary generate(const GenerateRequest& request,
                         const std::function<void(std::uint64_t done, std::uint64_t all)>& tell = {});

}  // namespace actformer::model
