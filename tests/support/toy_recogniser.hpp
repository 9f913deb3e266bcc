// Weights of a small recogniser that has learnt nothing.
#pragma once

#include <filesystem>

#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::test {

/// Writes them to `path`: they fit the persons, joints and classes of `dataset`.
inline void write_toy_recogniser(const std::filesystem::path& dataset, const std::filesystem::path& path) {
    const ingest::Dataset opened(dataset);
    const auto& header = opened.header();
    const auto graph = eval::recogniser_graph(header.topology.parents);
    const auto channels = header.persons * header.representation.numbers();
    eval::write_stgcn_weights(
        path, eval::random_stgcn_weights(static_cast<std::uint32_t>(channels),
                                         static_cast<std::uint32_t>(header.classes.size()), graph, 0.125, 5));
}

/// A line "NAME CLASS" of every clip, for --labels.
inline std::string labels_of_clips(const std::filesystem::path& dataset) {
    const ingest::Dataset opened(dataset);
    std::string lines;
    for (const auto& clip : opened.clips())
        lines += fmt::format("{} {}\n", clip.name, opened.header().classes.at(clip.label));
    return lines;
}

}  // namespace actformer::test
