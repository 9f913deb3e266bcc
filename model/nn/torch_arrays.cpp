#include "model/nn/torch_arrays.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/files/mapped_file.hpp"
#include "base/pytorch/torch_file.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"

namespace actformer::model {
namespace {

TorchArrays arrays_of_file(const TorchFile& file) {
    TorchArrays out;
    std::set<std::string> groups{""};
    for (const auto& tensor : file.tensors()) {
        auto group = tensor.group;
        std::ranges::replace(group, '/', '.');
        if (!group.empty()) group += '.';
        for (auto dot = group.find('.'); dot != std::string::npos; dot = group.find('.', dot + 1))
            groups.insert(group.substr(0, dot + 1));
        out.arrays.push_back(
            {group + tensor.name, {tensor.shape.begin(), tensor.shape.end()}, tensor.values()});
    }
    out.prefixes.assign(groups.begin(), groups.end());
    return out;
}

}  // namespace

std::vector<Array> TorchArrays::behind(const std::string& prefix) const {
    std::vector<Array> out;
    for (const auto& array : arrays)
        if (array.name.starts_with(prefix))
            out.push_back({array.name.substr(prefix.size()), array.shape, array.values});
    return out;
}

TorchArrays read_torch_arrays(const std::filesystem::path& path) {
    const MappedFile file(path);
    try {
        return arrays_of_file(TorchFile(file.text()));
    } catch (const Error& e) {
        throw Error("{}: {}", path.string(), e.what());
    }
}

std::pair<std::int64_t, std::int64_t> matrix_shape(const std::vector<Array>& arrays,
                                                   const std::string& name) {
    const auto found = std::ranges::find(arrays, name, &Array::name);
    if (found == arrays.end() || found->shape.size() != 2) return {0, 0};
    return {found->shape[0], found->shape[1]};
}

std::string names_of(const std::vector<Array>& arrays) {
    std::vector<std::string> names;
    for (const auto& array : arrays) names.push_back(in_quotes(array.name));
    return few_and_more(names, 3);
}

}  // namespace actformer::model
