#include "model/recognisers/stgcn_file.hpp"

#include "base/files/file.hpp"
#include "eval/weights_writer.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {

void save_stgcn_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                        const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                        const std::vector<std::string>& class_names) {
    auto file = weights_writer(arrays);
    eval::write_recogniser_attributes(
        file, "stgcn",
        {settings.channels, settings.classes, settings.graph.parents, settings.representation, class_names},
        settings.graph.center);
    for (const auto& [name, text] : notes) file.attribute(name, text);
    write_whole(path, file.checked_image());
}

}  // namespace actformer::model
