#include "ingest/dataset/view.hpp"

#include "base/error.hpp"

namespace actformer::ingest {

std::vector<std::size_t> clips_in(const Dataset& dataset, const std::string& split) {
    auto clips = dataset.split(split);
    if (clips.empty())
        throw Error("{}: split {} holds no clip; actformer inspect lists the splits",
                    dataset.folder().string(), split);
    return clips;
}

View load_view(kernels::Device& device, const Dataset& dataset, const std::string& split,
               const std::function<void(std::size_t, std::size_t)>& progress) {
    auto clips = clips_in(dataset, split);
    kernels::ClipTable table;
    const auto& header = dataset.header();
    table.persons = header.persons;
    table.nodes = header.nodes();
    table.numbers = header.representation.numbers();
    if (header.centre_windows) {
        const auto moving = header.representation.moving(table.nodes);
        table.centring = kernels::Centring{moving.root, moving.first, moving.count};
    }
    for (const auto c : clips) {
        const auto& clip = dataset.clips()[c];
        if (clip.frames == 0) throw Error("{}: clip {} has no frames", dataset.folder().string(), clip.name);
        table.frames.push_back(clip.frames);
        table.labels.push_back(clip.label);
    }
    kernels::ClipStore store(device, std::move(table));
    for (std::size_t i = 0; i < clips.size(); ++i) {
        store.load(i, dataset.motion(clips[i]).values);
        if (progress) progress(i + 1, clips.size());
    }
    return {std::move(clips), std::move(store)};
}

}  // namespace actformer::ingest
