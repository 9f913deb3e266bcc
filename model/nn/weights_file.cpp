#include "model/nn/weights_file.hpp"

#include "base/files/file.hpp"

namespace actformer::model {

hdf5::Writer weights_writer(const std::vector<Array>& arrays) {
    const auto count = [](const auto& values) { return values.size(); };
    std::size_t bytes = 0;
    for (const auto& array : arrays) bytes += std::visit(count, array.values) * sizeof(float);
    hdf5::Writer file(bytes);
    for (const auto& array : arrays) {
        const auto write = [&](const auto& values) {
            const std::vector<float> rounded(values.begin(), values.end());
            file.write<float>(array.name, {array.shape.begin(), array.shape.end()}, rounded);
        };
        std::visit(write, array.values);
    }
    return file;
}

void save_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                  const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                  const std::vector<std::string>& class_names) {
    auto file = weights_writer(arrays);
    file.attribute("kind", std::string("stgcn"));
    if (!class_names.empty()) file.attribute("class_names", class_names);
    file.attribute("channels", std::int64_t{settings.channels});
    file.attribute("classes", std::int64_t{settings.classes});
    file.attribute("parents",
                   std::vector<std::int64_t>(settings.graph.parents.begin(), settings.graph.parents.end()));
    file.attribute("center", std::int64_t{settings.graph.center});
    for (const auto& [name, text] : notes) file.attribute(name, text);
    file.image([&](std::string_view image) { write_whole(path, image); });
}

}  // namespace actformer::model
