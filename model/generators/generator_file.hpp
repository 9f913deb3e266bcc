// A generator on disk: its method, settings and weights, and all it takes to generate and draw without the dataset.
//
// HDF5. float32 datasets named as the method names its weights (ActFormer's `input.weight`, `blocks.0.qkv.weight_u`, ...: those
// that `actformer model` lists, and of each spectral norm the singular vectors _u and _v); attributes `model` (the method's
// name), `configuration` (YAML, every key), those of ingest::Subjects, and notes as text.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/generators/method.hpp"

namespace actformer::model {

struct GeneratorFile {
    std::filesystem::path path;  ///< of the weights themselves
    Config configuration;
    ingest::Subjects subjects;
    std::string checksum;  ///< of the file
    std::vector<Array> weights;

    /// Frames of a motion where nobody asks for another number: those of the windows that it was trained on.
    std::uint32_t frames() const {
        return static_cast<std::uint32_t>(configuration.get<std::int64_t>("frames"));
    }

    const Method& method() const { return method_named(configuration.model(), path.string()); }

    /// On libtorch's `device`. Throws Error where the weights are not those of the configuration's network.
    std::unique_ptr<Maker> maker(const std::string& device) const;
};

/// The file appears whole or not at all. Throws Error where it cannot be written.
void save_generator(const std::filesystem::path& path, const std::vector<Array>& weights,
                    const Config& config, const ingest::Subjects& subjects,
                    const std::map<std::string, std::string>& notes);

/// `path`: such a file, or the folder of a training, whose best weights are taken, else their EMA, else the last. Throws
/// Error, one line, for what is missing, damaged, not finite, or of another model.
GeneratorFile load_generator(const std::filesystem::path& path);

}  // namespace actformer::model
