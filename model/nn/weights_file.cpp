#include "model/nn/weights_file.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

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

std::vector<Array> read_arrays(const hdf5::Reader& file, const std::string& where) {
    std::vector<Array> arrays;
    const auto names = file.names();
    file.expect_room_for(names);
    for (const auto& name : names) {
        const auto shape = file.shape(name);
        auto values = file.read<float>(name);
        if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
            throw Error("{}: '{}' holds numbers that are not finite; take earlier weights", where, name);
        arrays.push_back({name, {shape.begin(), shape.end()}, std::move(values)});
    }
    return arrays;
}

}  // namespace actformer::model
