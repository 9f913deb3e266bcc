#include "model/generators/actformer/generator_file.hpp"

#include <algorithm>
#include <cmath>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/run_weights.hpp"
#include "model/generators/actformer/gan.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {
namespace {

namespace fs = std::filesystem;

std::string text_of(const hdf5::Reader& file, const std::string& name, const std::string& where) {
    const auto texts = file.attribute_texts(name);
    if (texts.size() != 1) throw Error("{}: attribute '{}' is not one text: damaged", where, name);
    return texts[0];
}

/// Arrays of the names and shapes that `network` has.
std::vector<Array> read_arrays(const hdf5::Reader& file, const Generator& network, const std::string& where) {
    auto arrays = arrays_of(network, "");
    for (auto& array : arrays) {
        const auto shape = file.shape(array.name);
        if (!std::equal(shape.begin(), shape.end(), array.shape.begin(), array.shape.end()))
            throw Error("{}: '{}' is of shape ({}) where its configuration wants ({})", where, array.name,
                        fmt::join(shape, ", "), fmt::join(array.shape, ", "));
        auto values = file.read<float>(array.name);
        if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
            throw Error("{}: '{}' holds numbers that are not finite; take earlier weights", where,
                        array.name);
        array.values = std::move(values);
    }
    return arrays;
}

}  // namespace

void save_generator(const fs::path& path, const std::vector<Array>& arrays, const Config& config,
                    const ingest::Subjects& subjects, const std::map<std::string, std::string>& notes) {
    auto file = weights_writer(arrays);
    file.attribute("model", std::string("generator"));
    file.attribute("configuration", config.yaml());
    ingest::write_subjects(file, subjects);
    for (const auto& [name, text] : notes) file.attribute(name, text);
    file.image([&](std::string_view image) { write_whole(path, image); });
}

GeneratorFile load_generator(const fs::path& path) {
    const auto at = eval::weights_of(path);
    const auto where = at.string();
    const hdf5::Reader file(at);
    if (!file.has_attribute("model") || text_of(file, "model", where) != "generator")
        throw Error("{}: not the weights of a generator; give a generator's RUN or its weights-*.h5", where);
    auto subjects = ingest::read_subjects(file, where);
    if (!subjects) throw Error("{}: does not say whose motions it generates: damaged", where);
    GeneratorFile loaded{generator_config(), std::move(*subjects), checksum_file(at), {}};
    loaded.configuration.load_text(text_of(file, "configuration", where), where);
    const auto& who = loaded.subjects;
    const auto settings =
        generator_settings(loaded.configuration, who.topology, who.persons, who.classes.size(), 3, where);
    loaded.network = std::make_shared<Generator>(settings, 0);
    load_arrays(*loaded.network, "", read_arrays(file, *loaded.network, where), where);
    loaded.network->eval();
    return loaded;
}

}  // namespace actformer::model
