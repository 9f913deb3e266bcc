#include "model/recognisers/stgcn_file.hpp"

#include "base/files/file.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {

void save_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                  const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                  const std::vector<std::string>& class_names) {
    auto file = weights_writer(arrays);
    file.attribute("kind", std::string("stgcn"));
    file.attribute("representation", settings.representation.name());
    if (!class_names.empty()) file.attribute("class_names", class_names);
    file.attribute("channels", std::int64_t{settings.channels});
    file.attribute("classes", std::int64_t{settings.classes});
    file.attribute("parents",
                   std::vector<std::int64_t>(settings.graph.parents.begin(), settings.graph.parents.end()));
    file.attribute("center", std::int64_t{settings.graph.center});
    for (const auto& [name, text] : notes) file.attribute(name, text);
    write_whole(path, file.checked_image());
}

}  // namespace actformer::model
