#include "model/nn/module_arrays.hpp"

#include <fmt/format.h>

#include "model/nn/tensor_array.hpp"

namespace actformer::model {
namespace {

std::vector<std::pair<std::string, at::Tensor>> tensors_of(const torch::nn::Module& module) {
    std::vector<std::pair<std::string, at::Tensor>> all;
    for (const auto& item : module.named_parameters()) all.emplace_back(item.key(), item.value());
    for (const auto& item : module.named_buffers()) all.emplace_back(item.key(), item.value());
    return all;
}

std::string state_name(std::size_t place) {
    return fmt::format("state.{}", place);
}

}  // namespace

std::vector<Array> arrays_of(const torch::nn::Module& module, const std::string& prefix) {
    std::vector<Array> arrays;
    for (const auto& [name, tensor] : tensors_of(module)) arrays.push_back(array_of(prefix + name, tensor));
    return arrays;
}

void load_arrays(const torch::nn::Module& module, const std::string& prefix, const std::vector<Array>& arrays,
                 const std::string& where) {
    for (const auto& [name, tensor] : tensors_of(module))
        copy_into(tensor, array_named(arrays, prefix + name, tensor.sizes().vec(), where), where);
}

void add_state(std::vector<Array>& arrays, const std::vector<at::Tensor>& tensors) {
    for (std::size_t i = 0; i < tensors.size(); ++i) arrays.push_back(array_of(state_name(i), tensors[i]));
}

void load_state(const std::vector<at::Tensor>& tensors, const std::vector<Array>& arrays,
                const std::string& where) {
    for (std::size_t i = 0; i < tensors.size(); ++i)
        copy_into(tensors[i], array_named(arrays, state_name(i), where), where);
}

}  // namespace actformer::model
