#include "model/recognisers/gru.hpp"

#include <cmath>

#include "base/files/file.hpp"
#include "eval/weights_writer.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {

std::vector<NetworkWeight> gru_weights(const GruSettings& settings) {
    std::vector<NetworkWeight> all;
    for (const auto& tensor : eval::gru_tensors(settings.network()))
        all.push_back({tensor.name,
                       {tensor.shape.begin(), tensor.shape.end()},
                       Init::uniform,
                       1 / std::sqrt(static_cast<double>(tensor.fan_in))});
    return all;
}

std::vector<SummaryLine> gru_summary(const GruSettings& settings, std::uint32_t frames) {
    const auto network = settings.network();
    const auto under = [&](const std::string& start, const std::string& end) {
        std::int64_t sum = 0;
        for (const auto& weight : gru_weights(settings))
            if (weight.name.starts_with(start) && weight.name.ends_with(end)) sum += weight.count();
        return sum;
    };
    const std::int64_t t = frames;
    return {{"recurrent.0", "GRU", {t, network.hidden}, under("recurrent.", "_l0")},
            {"recurrent.1", "GRU", {t, network.hidden}, under("recurrent.", "_l1")},
            {"linear1", "of the last frame, tanh: the features", {network.features}, under("linear1.", "")},
            {"linear2", "logits", {network.classes}, under("linear2.", "")}};
}

void save_gru_weights(const std::filesystem::path& path, const GruSettings& settings,
                      const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                      const std::vector<std::string>& class_names) {
    auto file = weights_writer(arrays);
    eval::write_recogniser_attributes(
        file, "gru",
        {settings.channels, settings.classes, settings.parents, settings.representation, class_names});
    for (const auto& [name, text] : notes) file.attribute(name, text);
    write_whole(path, file.checked_image());
}

}  // namespace actformer::model
