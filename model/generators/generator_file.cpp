#include "model/generators/generator_file.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/run_weights.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t most_persons = 100;  // of a clip, as ingest has it

std::string text_of(const hdf5::Reader& file, const std::string& name, const std::string& where) {
    const auto texts = file.attribute_texts(name);
    if (texts.size() != 1) throw Error("{}: attribute '{}' is not one text: damaged", where, name);
    return texts[0];
}

}  // namespace

void save_generator(const fs::path& path, const std::vector<Array>& weights, const Config& config,
                    const ingest::Subjects& subjects, const std::map<std::string, std::string>& notes) {
    auto file = weights_writer(weights);
    file.attribute("model", config.model());
    file.attribute("configuration", config.yaml());
    ingest::write_subjects(file, subjects);
    for (const auto& [name, text] : notes) file.attribute(name, text);
    write_whole(path, file.checked_image());
}

std::unique_ptr<Maker> GeneratorFile::maker(const std::string& device) const {
    return method().maker(configuration, spec_of(subjects, path.string()), weights, device);
}

GeneratorFile load_generator(const fs::path& path) {
    const auto at = eval::weights_of(path);
    const auto where = at.string();
    const hdf5::Reader file(at);
    if (!file.has_attribute("model") || !file.has_attribute("configuration"))
        throw Error("{}: not the weights of a generator; give a generator's RUN or its weights-*.h5", where);
    auto subjects = ingest::read_subjects(file, where);
    if (!subjects) throw Error("{}: does not say whose motions it generates: damaged", where);
    if (subjects->persons > most_persons)
        throw Error("{}: motions of {} persons, and generators make up to {}: damaged", where,
                    subjects->persons, most_persons);
    auto config = generator_config(method_named(text_of(file, "model", where), where));
    config.load_text(text_of(file, "configuration", where), where);
    return {at, std::move(config), std::move(*subjects), checksum_file(at), read_arrays(file, where)};
}

}  // namespace actformer::model
