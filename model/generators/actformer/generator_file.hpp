// A generator on disk: its weights and all it takes to generate and draw without the dataset. Includes torch headers.
//
// HDF5. float32 datasets named as the network's parameters and buffers (`input.weight`, `blocks.0.qkv.weight_u`, ...: those
// that `actformer model` lists, and of each spectral norm the singular vectors _u and _v); attributes `model` ("generator"),
// `configuration` (YAML, every key), `representation`, those of ingest::Subjects, and notes as text.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ingest/dataset/subjects.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/nn/array.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

struct GeneratorFile {
    Config configuration;
    ingest::Subjects subjects;
    std::string checksum;  ///< of the file
    std::shared_ptr<Generator> network;
};

/// The file appears whole or not at all. Throws Error where it cannot be written.
void save_generator(const std::filesystem::path& path, const std::vector<Array>& arrays, const Config& config,
                    const ingest::Subjects& subjects, const std::map<std::string, std::string>& notes);

/// `path`: such a file, or the folder of a training, whose best weights are taken, else its mean ones, else its last. Throws
/// Error, one line, for what is missing, damaged, of another shape, not finite, or of another model.
GeneratorFile load_generator(const std::filesystem::path& path);

}  // namespace actformer::model
