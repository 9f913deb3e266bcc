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

// All arrays are looked at for every prefix, and those behind it are copied: an array is behind no more than most_dots + 1 of them.
constexpr std::ptrdiff_t most_dots = 32;
constexpr std::size_t most_prefixes = 1000;

/// Those of a group's names, each with the dot behind it.
void add_prefixes(const std::string& group, std::set<std::string>& prefixes) {
    if (const auto dots = std::ranges::count(group, '.'); dots > most_dots)
        throw Error("tensors behind {} names, as in {}, where {} are enough: made to exhaust its readers",
                    dots, in_quotes(group), most_dots);
    for (auto dot = group.find('.'); dot != std::string::npos; dot = group.find('.', dot + 1))
        prefixes.insert(group.substr(0, dot + 1));
    if (prefixes.size() > most_prefixes)
        throw Error(
            "tensors in more than {} dicts, as in {}: made to exhaust its readers; save the model's "
            "state_dict() alone",
            most_prefixes, in_quotes(group));
}

TorchArrays arrays_of_file(const TorchFile& file) {
    TorchArrays out;
    std::set<std::string> prefixes{""};
    for (const auto& tensor : file.tensors()) {
        auto group = tensor.group;
        std::ranges::replace(group, '/', '.');
        if (!group.empty()) group += '.';
        add_prefixes(group, prefixes);
        out.arrays.push_back(
            {group + tensor.name, {tensor.shape.begin(), tensor.shape.end()}, tensor.values()});
    }
    out.prefixes.assign(prefixes.begin(), prefixes.end());
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
