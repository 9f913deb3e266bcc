#include "eval/features_file.hpp"

#include "kernels/error.hpp"

namespace actformer::eval {

FeaturesFile::FeaturesFile(const std::filesystem::path& path, std::uint64_t sequences, std::uint64_t features,
                           std::uint64_t classes)
    : path_(path),
      aside_(path.string() + ".partial"),
      sequences_(sequences),
      features_(features),
      classes_(classes),
      writer_(aside_) {}

FeaturesFile::~FeaturesFile() {
    std::error_code gone;
    std::filesystem::remove(aside_, gone);
}

void FeaturesFile::add(std::uint64_t first, std::span<const float> features, std::span<const float> logits) {
    writer_.write_rows("features", {sequences_, features_}, first, features);
    writer_.write_rows("logits", {sequences_, classes_}, first, logits);
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

void FeaturesFile::finish() {
    std::error_code error;
    if (writer_.finish())
        std::filesystem::rename(aside_, path_, error);
    else
        error = std::make_error_code(std::errc::no_space_on_device);
    if (error) throw Error("{}: cannot be written: {}", path_.string(), error.message());
}

}  // namespace actformer::eval
