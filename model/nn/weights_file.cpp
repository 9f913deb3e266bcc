#include "model/nn/weights_file.hpp"

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

}  // namespace actformer::model
