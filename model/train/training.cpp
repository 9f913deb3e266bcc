#include "model/train/training.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "base/random/splitmix.hpp"
#include "base/text/suggestion.hpp"

namespace actformer::model {
namespace {

/// To a GPU by way of memory that it can read while the processor goes on.
at::Tensor sent(const at::Tensor& values, const at::Device& device) {
    if (device.is_cpu()) return values;
    return values.pin_memory().to(device, values.scalar_type(), /*non_blocking=*/true);
}

}  // namespace

std::uint64_t step_seed(std::uint64_t seed, std::uint64_t step) {
    return mixed(seed * golden_step + step + 1);
}

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

ingest::Dataset dataset_to_train_on(const std::string& data) {
    if (data.empty()) throw Error("no dataset: give --data DATASET, or data: in the configuration");
    return ingest::Dataset(ingest::one_dataset_at(data));
}

void check_split(const ingest::Dataset& dataset, const std::string& key, const std::string& split) {
    const auto known = dataset.split_names();
    if (std::ranges::find(known, split) != known.end()) return;
    auto remedy = suggestion(split, known);
    if (remedy.empty())
        remedy =
            fmt::format("; give {}=all, or ingest the raw data with --split {}=FIELD:VALUE,...", key, split);
    throw Error("{}: no split '{}'; there is {}{}", dataset.folder().string(), split, fmt::join(known, ", "),
                remedy);
}

std::optional<kernels::Device> device_that_draws(const std::string& opencl,
                                                 const std::function<void(const std::string&)>& note) {
    if (opencl == no_opencl) return std::nullopt;
    const char* set = std::getenv("ACTFORMER_DEVICE");
    const bool named = !opencl.empty() || (set && *set);
    if (named || !kernels::list_devices().empty()) return std::optional<kernels::Device>(opencl);
    if (note) note("no OpenCL device: the processor draws the windows");
    return std::nullopt;
}

ingest::View view_to_draw(std::optional<kernels::Device>& device, const ingest::Dataset& dataset,
                          const std::string& split, ingest::Joints joints) {
    return device ? ingest::load_view(*device, dataset, split, joints)
                  : ingest::load_view(dataset, split, joints);
}

void tell_split(const ingest::Dataset& dataset, const TrainerSettings& settings, std::uint64_t clips,
                std::uint64_t windows_a_step, const std::string& tests,
                const std::function<void(const std::string&)>& note) {
    if (!note) return;
    const auto windows = (clips + windows_a_step - 1) / windows_a_step * windows_a_step;
    note(fmt::format("trains on split {}: {} clips, {} windows an epoch; {}", settings.train_split, clips,
                     windows, tests));
    if (settings.train_split == "all" &&
        std::ranges::any_of(dataset.header().splits, [](const auto& split) { return split.name == "train"; }))
        note(
            fmt::format("{} has a split train, and this training takes all clips; train_split=train keeps "
                        "the others to test on",
                        dataset.folder().string()));
}

at::Tensor values_of(const Windows& windows, std::int64_t channels, std::int64_t frames, std::int64_t joints,
                     const at::Device& device) {
    return sent(at::from_blob(windows.values, {windows.count, channels, frames, joints}, at::kFloat), device);
}

at::Tensor labels_of(const Windows& windows, const at::Device& device) {
    auto labels = at::empty({windows.count}, at::kLong);
    std::copy_n(windows.labels, windows.count, labels.data_ptr<std::int64_t>());
    return sent(labels, device);
}

}  // namespace actformer::model
