#include "eval/weights_reader.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "ingest/dataset/subjects.hpp"

namespace actformer::eval {
namespace {

constexpr std::int64_t most_channels = 96, most_classes = 100'000, most_joints = 1000;

std::string text_of(const TensorShape& shape) {
    return fmt::format("({})", fmt::join(shape, ", "));
}

std::vector<int> read_parents(const hdf5::Reader& file, const std::string& path) {
    const auto values = file.attribute_numbers("parents");
    const auto count = static_cast<std::int64_t>(values.size());
    if (count == 0 || count > most_joints)
        throw Error("{}: attribute 'parents' lists {} joints", path, count);
    for (std::size_t k = 0; k < values.size(); ++k)
        if (values[k] < -1 || values[k] >= count)
            throw Error("{}: attribute 'parents' is no tree: joint {} hangs from {}, which is not there",
                        path, k, values[k]);
    if (const auto roots = std::count(values.begin(), values.end(), -1); roots != 1)
        throw Error("{}: attribute 'parents' is no tree: {} joints have -1, and one root is expected", path,
                    roots);
    for (std::size_t k = 0; k < values.size(); ++k) {
        std::int64_t at = static_cast<std::int64_t>(k), steps = 0;
        while (at >= 0 && steps++ <= count) at = values[static_cast<std::size_t>(at)];
        if (at >= 0) throw Error("{}: attribute 'parents' is no tree: joint {} hangs from itself", path, k);
    }
    return {values.begin(), values.end()};
}

}  // namespace

std::uint32_t one_number(const hdf5::Reader& file, const std::string& path, const std::string& name,
                         std::int64_t least, std::int64_t most) {
    const auto values = file.attribute_numbers(name);
    if (values.size() != 1 || values[0] < least || values[0] > most)
        throw Error("{}: attribute '{}' is not one number from {} to {}", path, name, least, most);
    return static_cast<std::uint32_t>(values[0]);
}

std::vector<float> read_tensor(const hdf5::Reader& file, const std::string& path, const std::string& name,
                               const TensorShape& expected) {
    const auto stored = file.shape(name);
    if (const TensorShape shape(stored.begin(), stored.end()); shape != expected)
        throw Error("{}: '{}' is {} where {} is expected", path, name, text_of(shape), text_of(expected));
    auto values = file.read<float>(name);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            throw Error("{}: '{}' holds {} at {}: training went wrong", path, name, values[i], i);
    return values;
}

RecogniserAttributes read_attributes(const hdf5::Reader& file, const std::string& path) {
    RecogniserAttributes about;
    about.channels = one_number(file, path, "channels", 1, most_channels);
    about.classes = one_number(file, path, "classes", 1, most_classes);
    about.representation = ingest::read_representation(file, path).value_or(ingest::Representation::limb);
    if (file.has_attribute("class_names")) about.class_names = file.attribute_texts("class_names");
    if (!about.class_names.empty() && about.class_names.size() != about.classes)
        throw Error("{}: attribute 'class_names' names {} of {} classes", path, about.class_names.size(),
                    about.classes);
    about.parents = read_parents(file, path);
    return about;
}

}  // namespace actformer::eval
