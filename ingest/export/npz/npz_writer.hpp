// NumPy's .npz, written: arrays by name, for numpy.load without pickles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ingest/export/npz/zip_writer.hpp"

namespace actformer::ingest {

/// A zip archive with a NAME.npy a array, each in format 1.0 and C order. Texts become arrays of UCS-4 as wide as the longest.
class NpzWriter {
  public:
    explicit NpzWriter(const std::filesystem::path& path, Sync sync = Sync::now) : zip_(path, sync) {}

    using Shape = std::vector<std::uint64_t>;
    void add(const std::string& name, const Shape& shape, std::span<const float> values);
    void add(const std::string& name, const Shape& shape, std::span<const double> values);
    void add(const std::string& name, const Shape& shape, std::span<const std::int64_t> values);
    void add(const std::string& name, const std::vector<std::string>& texts);  ///< UTF-8
    void add(const std::string& name, const std::string& text);                ///< of shape ()

    /// The file appears. Throws Error where not all of it could be written.
    void finish() { zip_.finish(); }

  private:
    void add_bytes(const std::string& name, const std::string& type, const Shape& shape,
                   std::string_view bytes);
    void add_texts(const std::string& name, const Shape& shape, std::span<const std::string> texts);
    ZipWriter zip_;
};

}  // namespace actformer::ingest
