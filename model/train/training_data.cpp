#include "model/train/training_data.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "base/text/suggestion.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

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

}  // namespace actformer::model
