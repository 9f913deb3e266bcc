#include "model/train/torch_device.hpp"

#include <cstdlib>

#include "base/error.hpp"

namespace actformer::model {

at::Device torch_device(const std::string& name, const std::string& option) {
    try {
        const at::Device device(name);
        at::zeros({1}, at::TensorOptions().device(device));
        return device;
    } catch (const std::exception&) {
        if (name.starts_with("cuda") && !at::Context::hasCUDART())
            throw Error(
                "device {}: this libtorch was built without CUDA; {}cpu always works, and docs/gpu.md tells "
                "how to build with one that has it",
                name, option);
        throw Error("device {}: libtorch finds none of that name here; {}cpu always works", name, option);
    }
}

void set_tf32_and_determinism(const TrainerSettings& settings, const at::Device& device) {
    if (settings.tf32 && !device.is_cuda())
        throw Error("tf32: true is for CUDA; with device: {}, leave it out", settings.device);
    auto& context = at::globalContext();
    context.setAllowTF32CuBLAS(settings.tf32);
    context.setAllowTF32CuDNN(settings.tf32);
    if (!device.is_cuda()) return;
    if (settings.deterministic)
        ::setenv("CUBLAS_WORKSPACE_CONFIG", ":4096:8", 0);  // before cuBLAS begins, as it demands
    context.setDeterministicAlgorithms(settings.deterministic, /*warn_only=*/false);
    context.setDeterministicCuDNN(settings.deterministic);
}

at::ScalarType torch_type(const std::string& precision) {
    return precision == "float64" ? at::kDouble : at::kFloat;
}

}  // namespace actformer::model
