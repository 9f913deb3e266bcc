#include "model/generators/import_generator.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "model/generators/generator_file.hpp"
#include "model/nn/one_line.hpp"
#include "model/nn/torch_arrays.hpp"

namespace actformer::model {
namespace {

struct Found {
    const Method* method = nullptr;
    PublicWeights weights;
};

Found method_of(const TorchArrays& file, const MotionSpec& spec) {
    std::string known;
    for (const auto& method : methods()) {
        if (!method.public_weights) continue;
        known += (known.empty() ? "" : ", ") + method.name;
        for (const auto& prefix : file.prefixes)
            if (auto weights = method.public_weights(file.behind(prefix), spec))
                return {&method, std::move(*weights)};
    }
    throw Error("{}: holds no released weights of {}; it has {}", spec.where, known,
                file.arrays.empty() ? "no tensors" : names_of(file.arrays));
}

std::uint64_t count_of(const std::vector<Array>& weights) {
    std::uint64_t count = 0;
    for (const auto& weight : weights)
        count += std::visit([](const auto& values) { return values.size(); }, weight.values);
    return count;
}

}  // namespace

ImportedGenerator import_generator(const ImportGeneratorRequest& request) try {
    const auto arrays = read_torch_arrays(request.file);
    const ingest::Dataset dataset(ingest::one_dataset_at(request.data));
    const auto subjects = ingest::subjects_of(dataset);
    const auto spec = spec_of(subjects, request.file.string());
    const auto found = method_of(arrays, spec);
    auto config = generator_config(*found.method);
    for (const auto& setting : found.weights.settings) config.override_with(setting);
    for (const auto& setting : request.overrides) config.override_with(setting);
    found.method->maker(config, spec, found.weights.weights, "cpu");  // what cannot be loaded is refused
    save_generator(request.out, found.weights.weights, config, subjects,
                   {{"program", "actformer " ACTFORMER_VERSION},
                    {"imported", request.file.filename().string()},
                    {"imported_checksum", checksum_file(request.file)}});
    return {found.method->name, found.method->title, count_of(found.weights.weights), spec.classes};
} catch (const c10::Error& e) {
    throw Error("libtorch: {}", one_line(e));
}

}  // namespace actformer::model
