#include "model/weights_file.hpp"

#include "ingest/file.hpp"
#include "ingest/hdf5/writer.hpp"

namespace actformer::model {

void save_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                  const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes) {
    std::size_t bytes = 0;
    for (const auto& array : arrays) bytes += array.values.size() * sizeof(float);
    ingest::hdf5::Writer file(bytes);
    for (const auto& array : arrays)
        file.write<float>(array.name, {array.shape.begin(), array.shape.end()}, array.values);
    file.attribute("channels", std::int64_t{settings.channels});
    file.attribute("classes", std::int64_t{settings.classes});
    file.attribute("parents",
                   std::vector<std::int64_t>(settings.graph.parents.begin(), settings.graph.parents.end()));
    file.attribute("center", std::int64_t{settings.graph.center});
    for (const auto& [name, text] : notes) file.attribute(name, text);
    file.image([&](std::string_view image) { ingest::write_whole(path, image); });
}

}  // namespace actformer::model
