// A features file in the making: rows come in any order, and the file appears when all are there.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ingest/hdf5.hpp"

namespace actformer::eval {

class FeaturesFile {
  public:
    /// Written beside `path` until finish(). Throws Error where that cannot be.
    FeaturesFile(const std::filesystem::path& path, std::uint64_t sequences, std::uint64_t features,
                 std::uint64_t classes);
    ~FeaturesFile();
    FeaturesFile(const FeaturesFile&) = delete;
    FeaturesFile& operator=(const FeaturesFile&) = delete;

    /// `rows` consecutive sequences from `first` on: features (rows, features), logits (rows, classes).
    void add(std::uint64_t first, std::span<const float> features, std::span<const float> logits);

    void names(const std::vector<std::string>& names);
    void labels(const std::vector<std::uint32_t>& labels);
    void note(const std::string& attribute, const std::string& value);

    /// Throws Error where not all of it could be written.
    void finish();

  private:
    std::filesystem::path path_, aside_;
    std::uint64_t sequences_, features_, classes_;
    ingest::hdf5::Writer writer_;
};

}  // namespace actformer::eval
