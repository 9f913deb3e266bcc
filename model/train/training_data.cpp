#include "model/train/training_data.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "base/text/lower_case.hpp"
#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {
namespace {

/// What names a device: the key `opencl`, else ACTFORMER_DEVICE; empty where nothing does.
std::string wish_of(const std::string& opencl) {
    const char* set = std::getenv("ACTFORMER_DEVICE");
    return opencl.empty() && set ? set : opencl;
}

}  // namespace

ingest::Dataset dataset_to_train_on(const std::string& data) {
    if (data.empty()) throw Error("no dataset: give --data DATASET, or data: in the configuration");
    return ingest::Dataset(ingest::one_dataset_at(data));
}

void check_split(const ingest::Dataset& dataset, const std::string& key, const std::string& split) {
    const auto known = dataset.split_names();
    if (std::ranges::find(known, split) != known.end()) return;
    const auto nearest = nearest_word(split, known);
    const auto remedy =
        nearest.empty()
            ? fmt::format("; give {}=all, or ingest the raw data with --split {}=FIELD:VALUE,...", key, split)
            : fmt::format("; did you mean {0}? Then give {1}={0}", printable(nearest), key);
    throw Error("{}: no split '{}'; there is {}{}", dataset.folder().string(), split, fmt::join(known, ", "),
                remedy);
}

std::size_t device_of_process(const std::vector<kernels::DeviceInfo>& devices, const std::string& opencl,
                              int local) {
    const auto chosen = kernels::choose_device(devices, opencl);
    const auto& first = devices[chosen];
    const auto wish = lower_case(wish_of(opencl));
    if (!wish.empty() && wish.find_first_not_of("0123456789") == std::string::npos) return chosen;
    const bool by_name = wish != lower_case(first.type);
    std::vector<std::size_t> alike;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto& d = devices[(chosen + i) % devices.size()];
        if (d.type == first.type && d.platform == first.platform && d.shares_memory == first.shares_memory &&
            (!by_name || lower_case(d.name).find(wish) != std::string::npos))
            alike.push_back(d.index);
    }
    return alike[static_cast<std::size_t>(local) % alike.size()];
}

std::optional<kernels::Device> device_that_draws(const std::string& opencl, int local,
                                                 const std::function<void(const std::string&)>& note) {
    if (opencl == no_opencl) return std::nullopt;
    const auto devices = kernels::list_devices();
    if (!devices.empty() || !wish_of(opencl).empty())
        return std::optional<kernels::Device>(std::to_string(device_of_process(devices, opencl, local)));
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
