#include "ingest/dataset/view.hpp"

#include <optional>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {

std::vector<std::size_t> clips_in(const Dataset& dataset, const std::string& split) {
    auto clips = dataset.split(split);
    if (clips.empty())
        throw Error("{}: split {} holds no clip; actformer inspect lists the splits",
                    dataset.folder().string(), split);
    return clips;
}

Representation representation_seen(Representation own, Joints joints) {
    return joints == Joints::own ? own : Representation(Representation::limb);
}

const Topology& topology_seen(const Topology& own, Joints joints) {
    return joints == Joints::own ? own : common15();
}

Representation representation_of(const Dataset& dataset, Joints joints) {
    return representation_seen(dataset.header().representation, joints);
}

const Topology& topology_of(const Dataset& dataset, Joints joints) {
    if (joints == Joints::common15)
        expect_common_joints(dataset.header().topology, dataset.folder().string());
    return topology_seen(dataset.header().topology, joints);
}

namespace {

/// What is known of the clips, as those who are shown `joints` see them.
kernels::ClipTable table_of(const Dataset& dataset, const std::vector<std::size_t>& clips, Joints joints) {
    kernels::ClipTable table;
    const auto representation = representation_of(dataset, joints);
    table.persons = dataset.header().persons;
    table.nodes = representation.nodes(topology_of(dataset, joints));
    table.numbers = representation.numbers();
    if (dataset.header().centre_windows || joints == Joints::common15) {
        const auto moving = representation.moving(table.nodes);
        table.centring = kernels::Centring{moving.root, moving.first, moving.count};
    }
    for (const auto c : clips) {
        const auto& clip = dataset.clips()[c];
        if (clip.frames == 0) throw Error("{}: clip {} has no frames", dataset.folder().string(), clip.name);
        table.frames.push_back(clip.frames);
        table.labels.push_back(clip.label);
    }
    return table;
}

/// Reads the clips into a store that has room for them.
View loaded(kernels::ClipStore store, std::vector<std::size_t> clips, const Dataset& dataset, Joints joints) {
    std::optional<CommonJoints> common;
    if (joints == Joints::common15) common.emplace(dataset.body(clips[0]), dataset.folder().string());
    for (std::size_t i = 0; i < clips.size(); ++i) {
        const auto motion = dataset.motion(clips[i]);
        store.load(i, common ? common->of(motion, dataset.bone_length(clips[i])).values : motion.values);
    }
    return {std::move(clips), std::move(store)};
}

}  // namespace

View load_view(kernels::Device& device, const Dataset& dataset, const std::string& split, Joints joints) {
    auto clips = clips_in(dataset, split);
    kernels::ClipStore store(device, table_of(dataset, clips, joints));
    return loaded(std::move(store), std::move(clips), dataset, joints);
}

View load_view(const Dataset& dataset, const std::string& split, Joints joints) {
    auto clips = clips_in(dataset, split);
    kernels::ClipStore store(table_of(dataset, clips, joints));
    return loaded(std::move(store), std::move(clips), dataset, joints);
}

}  // namespace actformer::ingest
