#include "eval/scoring/features_file.hpp"

#include <algorithm>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/metrics/confusion.hpp"
#include "ingest/dataset/own_kind.hpp"

namespace actformer::eval {
namespace {

/// Rows and columns of a matrix in the file.
std::pair<std::size_t, std::size_t> matrix(const hdf5::Reader& file, const std::string& name,
                                           const std::string& where) {
    const auto shape = file.shape(name);
    if (shape.size() != 2)
        throw Error("{}: '{}' has {} axes where samples and their numbers are two", where, name,
                    shape.size());
    return {shape[0], shape[1]};
}

std::vector<std::uint32_t> read_labels(const hdf5::Reader& file, const std::string& where) {
    if (!file.has("labels"))
        throw Error(
            "{}: holds no 'labels', the class of every sample from 0 on; make it from motions that tell "
            "their action, by names like A001_0 or the attribute `label`, or add them",
            where);
    std::vector<std::uint32_t> labels;
    for (const auto label : file.read<std::int64_t>("labels")) {
        if (label < 0 || label > 1'000'000)
            throw Error("{}: label {} of sample {} is no class", where, label, labels.size());
        labels.push_back(static_cast<std::uint32_t>(label));
    }
    return labels;
}

}  // namespace

FeaturesFile::FeaturesFile(const std::filesystem::path& path, std::uint64_t sequences, std::uint64_t features,
                           std::uint64_t classes)
    : sequences_(sequences), features_(features), classes_(classes), writer_(path) {}

void FeaturesFile::add(std::uint64_t first, std::span<const float> features, std::span<const float> logits) {
    writer_.write_rows("features", {sequences_, features_}, first, features);
    if (classes_ > 0) writer_.write_rows("logits", {sequences_, classes_}, first, logits);
}

void FeaturesFile::names(const std::vector<std::string>& names) {
    writer_.write_strings("names", names);
}

void FeaturesFile::labels(const std::vector<std::uint32_t>& labels) {
    writer_.write<std::uint32_t>("labels", {labels.size()}, labels);
}

void FeaturesFile::note(const std::string& attribute, const std::string& value) {
    writer_.attribute(attribute, value);
}

void FeaturesFile::frames(std::uint32_t shortest, std::uint32_t longest) {
    writer_.attribute("frames", std::vector<std::int64_t>{shortest, longest});
}

void FeaturesFile::finish() {
    writer_.finish();
}

bool is_own_features(const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    return file.has("features") && file.has_attribute("recogniser") && file.has_attribute("view");
}

bool is_as_written(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) &&
           own_checksum_of_file(path) == OwnChecksum::right;
}

StoredFeatures read_features(const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    const auto where = path.string();
    if (!file.has("features"))
        ingest::refuse_other_file(file, where, ingest::own::features, "give what `actformer features` makes");
    StoredFeatures out;
    auto& samples = out.samples;
    const auto [count, dimensions] = matrix(file, "features", where);
    samples.dimensions = dimensions;
    samples.labels = read_labels(file, where);
    if (count != samples.size())
        throw Error("{}: {} rows of features do not go with {} labels", where, count, samples.size());
    samples.features = file.read<double>("features");
    for (const auto label : samples.labels)
        samples.classes = std::max<std::size_t>(samples.classes, label + 1);
    if (file.has("logits")) {
        const auto [rows, classes] = matrix(file, "logits", where);
        if (rows != count)
            throw Error("{}: {} rows of logits do not go with {} of features", where, rows, count);
        check_class_count(classes, where);
        samples.classes = classes;
        samples.logits = file.read<float>("logits");
    }
    if (file.has("names")) out.names = file.read_strings("names");
    if (!out.names.empty() && out.names.size() != count)
        throw Error("{}: {} names do not go with {} rows of features", where, out.names.size(), count);
    if (file.has_attribute("frames")) {
        const auto frames = file.attribute_numbers("frames");
        if (frames.size() != 2) throw Error("{}: attribute 'frames' is not shortest and longest", where);
        out.shortest = static_cast<std::uint32_t>(frames[0]);
        out.longest = static_cast<std::uint32_t>(frames[1]);
    }
    check(samples, where);
    return out;
}

}  // namespace actformer::eval
